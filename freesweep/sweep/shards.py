"""Shards of a sweep on disk: each whole or absent, found again after any interruption, read where they are needed.

The folder ``<out>.parts`` holds a manifest (which specification, which code, when it was begun), a lock, and one file for
each finished shard: records of states, then of limits. Its name carries the SHA-256 of its plan, kind, number and bytes:
neither a stale nor a swapped shard is taken for another. When the atlas is whole, the folder goes.
"""

import contextlib
import errno
import hashlib
import json
import os
import shutil
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ..atlas.files import BLOCK, EnvironmentFault, write_whole
from ..status import NOT_CONVERGED
from .changes import changes
from .records import LIMIT, state, unsolved

GAP = 64  # records that are read along rather than passed over
NO_LOCKS = (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS)  # of a file system without them
DIGITS = 32  # of the SHA-256 in a name


class SweepError(ValueError):
    """A sweep that cannot go on: what lies at the output is not its own, or another process is at work there."""


class Shards:
    """The shards of one sweep beside its output file; one process at a time may hold them."""

    def __init__(self, out):
        self.out = Path(out)
        self.folder = Path(f"{out}.parts")
        self.started, self.lock, self.plan = None, None, ""

    def hold(self):
        """Make the folder and become its only writer; a process that ends, however it ends, lets go."""
        while not self._is_there():  # another process may finish, and remove the folder, in between
            self._let_go()
            try:
                self.folder.mkdir(exist_ok=True)
            except OSError as error:
                absent = "" if self.out.parent.is_dir() else f"; there is no folder {self.out.parent}, make it first"
                raise EnvironmentFault(f"cannot make the folder {self.folder}: {error.strerror}{absent}") from error
            with contextlib.suppress(FileNotFoundError):
                self._lock()

    def _lock(self):
        try:
            import fcntl
        except ImportError:  # not a POSIX system
            fcntl = None
        try:
            self.lock = os.open(self.folder / "lock", os.O_RDWR | os.O_CREAT, 0o644)
            if fcntl:
                fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self._let_go()
            raise SweepError(
                f"another process is sweeping into {self.out}; wait for it, or choose another output"
            ) from None
        except FileNotFoundError:
            raise
        except OSError as error:
            if error.errno in NO_LOCKS:  # a network disk: the user is trusted to start one sweep
                return
            self._let_go()
            raise EnvironmentFault(f"cannot lock the folder {self.folder}: {error.strerror}") from error

    def _let_go(self):
        if self.lock is not None:
            os.close(self.lock)
            self.lock = None

    def _is_there(self):
        with contextlib.suppress(FileNotFoundError):
            return self.lock is not None and os.path.samestat(os.fstat(self.lock), os.stat(self.folder / "lock"))
        return False

    def release(self):
        """Let another process write; a folder without a shard does not stay behind."""
        if self.lock is not None:
            if not any(self.folder.glob("*.bin")):
                shutil.rmtree(self.folder, ignore_errors=True)
            self._let_go()

    def open(self, identity, text, clear_others=False):
        """Begin, or go on with the specification ``text``; returns the whole shards there: (kind, index) -> file."""
        manifest = self.folder / "manifest.json"
        self.plan = identity["plan_sha256"]
        if manifest.exists():
            found = _read(manifest)
            self.started = found.get("started")
            differs = [key for key, wanted in identity.items() if found.get(key) != wanted]
            if differs and not clear_others and any(self.folder.glob("*-*.bin")):
                key = differs[0]
                changed = changes(found.get("specification"), text) if key == "specification_sha256" else ""
                raise SweepError(
                    f"{self.folder} holds an unfinished sweep whose {key} differs: {found.get(key)!r:.80} there,"
                    f" {identity[key]!r:.80} now{changed}; choose another output, or delete that folder to begin anew"
                )
            if differs:
                for path in self.folder.glob("*-*"):
                    path.unlink()
                manifest.unlink()
        if not manifest.exists():
            self.started = datetime.now(UTC).isoformat(timespec="seconds")
            content = identity | {"started": self.started, "specification": text}
            write_whole(manifest, json.dumps(content, indent=1).encode())
        for left in (*self.out.parent.glob(f".{self.out.name}.*.part"), *self.folder.glob(".*.part")):
            left.unlink(missing_ok=True)
        done = {}
        for path in sorted(self.folder.glob("*-*.bin")):
            if key := key_of(path, self.plan):
                done[key] = path
            else:
                path.unlink()
        return done

    def save(self, kind, index, states, limits):
        """Store one finished shard; returns its file."""
        return save(self.folder, self.plan, kind, index, states, limits)

    def tidy(self):
        """Remove the folder that a process left which was killed when its atlas was whole, unless another is at work."""
        if self.folder.exists():
            with contextlib.suppress(SweepError, EnvironmentFault):
                self.hold()
                self.clear()
            self.release()

    def clear(self):
        """Remove the folder and what a killed write of the atlas left: the atlas is whole."""
        shutil.rmtree(self.folder, ignore_errors=True)
        for left in self.out.parent.glob(f".{self.out.name}.*.part"):
            left.unlink(missing_ok=True)


def _read(manifest):
    try:
        found = json.loads(manifest.read_text())
        if isinstance(found, dict):
            return found
    except ValueError:
        pass
    raise SweepError(f"{manifest} is damaged; delete the folder {manifest.parent} to begin anew")


def examine(out):
    """``(whole, faulty)`` shard files of the unfinished sweep beside ``out``; nothing is changed."""
    folder = Path(f"{out}.parts")
    try:
        plan = json.loads((folder / "manifest.json").read_text()).get("plan_sha256", "")
    except (OSError, ValueError):
        plan = ""
    files = sorted(folder.glob("*-*.bin"))
    whole = [path for path in files if key_of(path, plan)]
    return whole, [path for path in files if path not in whole]


def save(folder, plan, kind, index, states, limits) -> Path:
    """Store one finished shard of a plan in a folder; returns its file."""
    content = states.tobytes() + limits.tobytes()
    digest = _digest(plan, kind, index)
    digest.update(content)
    path = folder / f"{kind}-{index:06d}-{digest.hexdigest()[:DIGITS]}.bin"
    write_whole(path, content)
    return path


def _digest(plan, kind, index):
    """What the bytes of a shard are hashed behind: whose shard it is, and which."""
    return hashlib.sha256(f"{plan} {kind} {index}\n".encode())


def key_of(path, plan):
    """``(kind, index)`` of a shard file, or None where its bytes, plan or number are not those it was named after."""
    kind, index, digest = path.stem.rsplit("-", 2)
    if not index.isdigit():
        return None
    found = _digest(plan, kind, int(index))
    with path.open("rb") as file:
        while block := file.read(BLOCK):
            found.update(block)
    return (kind, int(index)) if found.hexdigest()[:DIGITS] == digest else None


class Records:
    """The records of one kind of state, read from its shards a few at a time.

    ``parts`` are (first, last + 1) problems of each shard, ``first`` where each problem's states begin, ``paths`` the files;
    None: a shard that could not be solved, of which every state is ``not_converged``.
    """

    def __init__(self, kind, parts, first, paths):
        self.dtype, self.paths = state(kind), paths
        self.problems = np.array([a for a, _ in parts] + [parts[-1][1] if parts else 0], np.int64)
        self.rows = first[self.problems]

    def states(self, rows):
        """Records of states ``rows``, of any shape."""
        return self._read(rows, self.rows, self.dtype, np.zeros(len(self.paths), np.int64))

    def limits(self, problems):
        """Records of the limits of ``problems`` (n,)."""
        return self._read(problems, self.problems, LIMIT, np.diff(self.rows) * self.dtype.itemsize)

    def _read(self, numbers, edges, dtype, starts):
        """Records of that type with those ``numbers``; a shard holds those between two ``edges``, from a byte on."""
        wanted, index = np.unique(numbers, return_inverse=True)
        found = np.empty(len(wanted), dtype)
        cuts = np.searchsorted(wanted, edges)
        for shard in np.flatnonzero(np.diff(cuts)).tolist():
            own = wanted[cuts[shard] : cuts[shard + 1]] - edges[shard]
            if self.paths[shard] is None:
                found[cuts[shard] : cuts[shard + 1]] = unsolved(dtype, NOT_CONVERGED)
                continue
            ends = np.flatnonzero(np.diff(own) > GAP) + 1
            descriptor = os.open(self.paths[shard], os.O_RDONLY)
            try:
                for a, b in zip([0, *ends.tolist()], [*ends.tolist(), len(own)]):
                    low, high = int(own[a]), int(own[b - 1]) + 1
                    content = os.pread(
                        descriptor, (high - low) * dtype.itemsize, int(starts[shard]) + low * dtype.itemsize
                    )
                    if len(content) != (high - low) * dtype.itemsize:
                        raise EnvironmentFault(f"{self.paths[shard]} was cut short while it was in use; start again")
                    block = np.frombuffer(content, dtype)
                    found[cuts[shard] + a : cuts[shard] + b] = block[own[a:b] - low]
            finally:
                os.close(descriptor)
        return found[index.reshape(np.shape(numbers))]
