"""One shard on disk: its name carries the SHA-256 of its plan, kind, number and bytes.

Neither a stale nor a swapped shard is taken for another, a damaged one is found out whenever it is read, and no file of
others looks like one.
"""

import hashlib
import re
from collections import OrderedDict
from pathlib import Path
from threading import Lock

from ..atlas.files import EnvironmentFault, write_whole

DIGITS = 32  # of the SHA-256 in a name
NAME = re.compile(r"(?P<kind>free|blocked_force|blocked_torque)-(?P<index>\d{6,})-(?P<digest>[0-9a-f]{32})\.bin")
MOST_KEPT = 1 << 27  # [bytes] of shards in memory: all of the main job's


def save(folder, plan, kind, index, states, limits) -> Path:
    """Store one finished shard of a plan in a folder; returns its file."""
    content = states.tobytes() + limits.tobytes()
    path = Path(folder) / f"{kind}-{index:06d}-{_digest(plan, kind, index, content)}.bin"
    write_whole(path, content)
    return path


def key_of(path, plan):
    """``(kind, index)`` of a shard file, or None where its bytes, plan or number are not those it was named after."""
    made = NAME.fullmatch(path.name)
    if made is None:
        return None
    key = made["kind"], int(made["index"])
    return key if _digest(plan, *key, _read(path)) == made["digest"] else None


def shard_files(folder) -> list:
    """The files in a folder that are named as shards, in order."""
    return sorted(path for path in folder.iterdir() if NAME.fullmatch(path.name))


class Contents:
    """Bytes of the shards of a plan, each held against its name when it is read; the latest stay in memory."""

    def __init__(self, plan):
        self.plan, self.most = plan, MOST_KEPT
        self.kept, self.size, self.lock = OrderedDict(), 0, Lock()

    def __getitem__(self, path) -> bytes:
        with self.lock:
            if path in self.kept:
                self.kept.move_to_end(path)
                return self.kept[path]
        content, made = _read(path), NAME.fullmatch(path.name)
        if _digest(self.plan, made["kind"], int(made["index"]), content) != made["digest"]:
            raise EnvironmentFault(
                f"{path}: other bytes are read back than were written; check the disk. What is whole is kept: the same sweep"
                " solves this part again"
            )
        with self.lock:
            self.size += len(content) if path not in self.kept else 0
            self.kept[path] = content
            while self.size > self.most:
                self.size -= len(self.kept.popitem(last=False)[1])
        return content

    def forget(self):
        """Let go of the memory."""
        with self.lock:
            self.kept.clear()
            self.size = 0


def _digest(plan, kind, index, content):
    """What a name carries: whose shard it is, which, and its bytes."""
    digest = hashlib.sha256(f"{plan} {kind} {index}\n".encode())
    digest.update(content)
    return digest.hexdigest()[:DIGITS]


def _read(path):
    try:
        return path.read_bytes()
    except OSError as error:
        raise EnvironmentFault(
            f"cannot read {path}: {error.strerror}; the same sweep goes on from there, and solves this part again if you"
            " delete that file"
        ) from error
