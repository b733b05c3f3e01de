"""Shards of a sweep on disk: each whole or absent, found again after any interruption.

The folder ``<out>.parts`` holds a manifest (which specification, which code, when it was begun) and one file for each
finished shard, named after the SHA-256 of its bytes. When the atlas is whole, the folder goes.
"""

import hashlib
import io
import json
import shutil
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ..atlas.files import EnvironmentFault, write_whole

FIELDS = ("values", "bounds", "status", "slack", "limits")
BLOCKED = ("blocked", "blocked_bounds", "blocked_status", "blocked_stable")


class SweepError(ValueError):
    """A sweep that cannot go on: what lies at the output is not its own."""


class Shards:
    """The shards of one sweep beside its output file."""

    def __init__(self, out, identity):
        self.out = Path(out)
        self.folder = Path(f"{out}.parts")
        self.identity = identity
        self.started = None

    def open(self):
        """Begin, or go on; returns the shards already there: index -> results."""
        manifest = self.folder / "manifest.json"
        try:
            self.folder.mkdir(exist_ok=True)
        except OSError as error:
            raise EnvironmentFault(f"cannot make the folder {self.folder}: {error.strerror}") from error
        if manifest.exists():
            self._check(json.loads(manifest.read_text()))
        else:
            self.started = datetime.now(UTC).isoformat(timespec="seconds")
            content = self.identity | {"started": self.started}
            write_whole(manifest, json.dumps(content, indent=1).encode())
        return dict(filter(None, map(self._load, sorted(self.folder.glob("shard-*.npz")))))

    def _check(self, found):
        self.started = found.get("started")
        for key, wanted in self.identity.items():
            if found.get(key) != wanted:
                raise SweepError(
                    f"{self.folder} holds an unfinished sweep whose {key} differs: {found.get(key)!r:.80} there,"
                    f" {wanted!r:.80} now; choose another output, or delete that folder to begin anew"
                )

    def _load(self, path):
        """``(index, results)`` of a shard file, or None if its bytes are not those it was named after."""
        _, index, digest = path.stem.split("-")
        content = path.read_bytes()
        if hashlib.sha256(content).hexdigest()[:32] != digest:
            path.unlink()
            return None
        with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
            return int(index), {name: arrays[name] for name in arrays.files}

    def save(self, index, results):
        """Store one finished shard."""
        buffer = io.BytesIO()
        np.savez(buffer, **results)
        content = buffer.getvalue()
        digest = hashlib.sha256(content).hexdigest()[:32]
        write_whole(self.folder / f"shard-{index:06d}-{digest}.npz", content)

    def clear(self, only_others=False):
        """Remove the folder and what a killed write of the atlas left: the atlas is whole, or is to be made anew.

        ``only_others``: unless the folder is this sweep's own.
        """
        manifest = self.folder / "manifest.json"
        if only_others and manifest.exists():
            found = json.loads(manifest.read_text())
            if all(found.get(key) == wanted for key, wanted in self.identity.items()):
                return
        shutil.rmtree(self.folder, ignore_errors=True)
        for left in self.out.parent.glob(f".{self.out.name}.*.part"):
            left.unlink(missing_ok=True)
