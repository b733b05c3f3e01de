"""Shards of a sweep on disk: each whole or absent, found again after any interruption.

The folder ``<out>.parts`` holds a manifest (which specification, which code, when it was begun), a lock, and one file for
each finished shard: records of states, then of limits. When the atlas is whole, all that goes, and the folder too, unless
it holds files of others: nothing is removed but what carries the mark of sweeps.
"""

import contextlib
import json
import os
from datetime import UTC, datetime
from pathlib import Path

from ..atlas.files import IN_THE_MAKING, NO_LOCKS, EnvironmentFault, left_behind, write_whole
from .changes import changes
from .shard_file import NAME, key_of, save, shard_files

LOCK, MANIFEST, PLAN = "freesweep.lock", "manifest.json", "plan_sha256"


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
        if self.folder.is_symlink():
            raise SweepError(f"{self.folder} is a link, and no folder of shards; remove it, or choose another output")
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
            self.lock = os.open(self.folder / LOCK, os.O_RDWR | os.O_CREAT, 0o644)
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
            return self.lock is not None and os.path.samestat(os.fstat(self.lock), os.stat(self.folder / LOCK))
        return False

    def release(self):
        """Let another process write; a folder without a shard does not stay behind."""
        if self.lock is not None:
            with contextlib.suppress(OSError):
                if not shard_files(self.folder):
                    self._remove()
            self._let_go()

    def open(self, identity, text, clear_others=False):
        """Begin, or go on with the specification ``text``; returns the whole shards there: (kind, index) -> file."""
        manifest = self.folder / MANIFEST
        self.plan = identity[PLAN]
        if manifest.exists():
            found = _read(manifest)
            self.started = found.get("started")
            differs = [key for key, wanted in identity.items() if found.get(key) != wanted]
            if differs and not clear_others and shard_files(self.folder):
                key = differs[0]
                changed = changes(found.get("specification"), text) if key == "specification_sha256" else ""
                raise SweepError(
                    f"{self.folder} holds an unfinished sweep whose {key} differs: {found.get(key)!r:.80} there,"
                    f" {identity[key]!r:.80} now{changed}; choose another output, or delete that folder to begin anew"
                )
            if differs:
                for path in (*shard_files(self.folder), manifest):
                    path.unlink()
        if not manifest.exists():
            self.started = datetime.now(UTC).isoformat(timespec="seconds")
            content = identity | {"started": self.started, "specification": text}
            write_whole(manifest, json.dumps(content, indent=1).encode())
        for left in self._left_behind():
            left.unlink(missing_ok=True)
        done = {}
        for path in shard_files(self.folder):
            if key := key_of(path, self.plan):
                done[key] = path
            else:
                path.unlink()
        return done

    def save(self, kind, index, states, limits):
        """Store one finished shard; returns its file."""
        return save(self.folder, self.plan, kind, index, states, limits)

    def tidy(self, identity):
        """Remove what a process left that was killed when its atlas was whole, unless another is at work, or the shards
        there are of another sweep.
        """
        if self.folder.exists():
            with contextlib.suppress(SweepError, EnvironmentFault):
                self.hold()
                manifest = self.folder / MANIFEST
                found = _read(manifest) if manifest.exists() else identity
                if all(found.get(key) == wanted for key, wanted in identity.items()):
                    self.clear()
            self.release()

    def clear(self):
        """Remove the shards and what a killed write of the atlas left: the atlas is whole."""
        with contextlib.suppress(OSError):
            for path in (*shard_files(self.folder), *self._left_behind()):
                path.unlink(missing_ok=True)
            self._remove()

    def _remove(self):
        """Remove manifest and lock, and the folder unless it holds files of others."""
        manifest = self.folder / MANIFEST
        if manifest.exists() and _is_manifest(manifest):
            manifest.unlink()
        (self.folder / LOCK).unlink(missing_ok=True)
        self.folder.rmdir()

    def _left_behind(self):
        """Files in the making of killed processes: of the atlas, of shards, of the manifest."""
        inside = [(path, IN_THE_MAKING.fullmatch(path.name)) for path in self.folder.iterdir()]
        own = [path for path, made in inside if made and (made["name"] == MANIFEST or NAME.fullmatch(made["name"]))]
        return [*left_behind(self.out.parent, self.out.name), *own]


def _read(manifest):
    """What a manifest says; raises :class:`SweepError`."""
    with contextlib.suppress(ValueError):
        found = json.loads(manifest.read_text())
        if isinstance(found, dict) and PLAN in found:
            return found
    raise SweepError(
        f"{manifest} is damaged, or not of a sweep; choose another output, or delete that file to begin anew"
    )


def _is_manifest(path):
    try:
        return bool(_read(path))
    except SweepError:
        return False


def examine(out):
    """``(whole, faulty)`` shard files of the unfinished sweep beside ``out``; nothing is changed."""
    folder = Path(f"{out}.parts")
    try:
        plan = _read(folder / MANIFEST)[PLAN]
    except (OSError, SweepError):
        plan = ""
    files = shard_files(folder)
    whole = [path for path in files if key_of(path, plan)]
    return whole, [path for path in files if path not in whole]
