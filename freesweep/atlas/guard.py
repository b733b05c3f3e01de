"""Whether the file of a stranger may be handed to the netCDF library: looked through first, object by object.

An HDF5 file can name other files (external storage, links, virtual datasets), declare petabytes in kilobytes, and hold
types and filters that no atlas has. What is let through here reads from this file alone, and no more bytes than its size
explains.
"""

import math
import stat
import zlib
from pathlib import Path

from .files import check_environment
from .heaps import damaged_heap

SIGNATURE = b"\x89HDF\r\n\x1a\n"
LARGEST_FILE = 1 << 40  # [bytes]: more than an atlas of spec.MAX_POINTS
MOST_OBJECTS = 512  # in the file, and attributes of one object
MOST_NUMBERS = 1 << 40  # of one variable, before its bytes are held against those of the file
ATTRIBUTE_BYTES = 1 << 20  # of one attribute: a specification has 256 kB at most
CHUNK_BYTES = 1 << 20  # of one chunk, unpacked; write.py makes half of it
MOST_LABELS, LABEL_BYTES = 100_000, 1000  # names of designs
LABELS = ("design",)  # the variables that hold text
UNPACKED = 1 << 24  # [bytes] that opening unpacks to see that chunks are no larger than they say
BOMB, BOMB_BYTES = 100, 1 << 30  # times that a file may grow when it is unpacked, beyond so many bytes
PACKED = ((), ("deflate",), ("shuffle", "deflate"))  # pipelines that an atlas may have
ATTACHED = ("DIMENSION_LIST", "REFERENCE_LIST")  # by which netCDF knows which variable has which dimension


class Unsafe(ValueError):
    """A file that is not opened; the message says why."""


def check_file(path):
    """Refuse what is no plain file of the size and kind of an atlas; raises :class:`Unsafe`, FileNotFoundError, OSError."""
    there = Path(path).stat()
    if not stat.S_ISREG(there.st_mode):
        raise Unsafe("it is a folder, a pipe or a device, and no file")
    if there.st_size > LARGEST_FILE:
        raise Unsafe(f"it has {there.st_size:,} bytes, more than any atlas ({LARGEST_FILE:,})")
    with Path(path).open("rb") as file:
        if file.read(len(SIGNATURE)) != SIGNATURE:
            raise Unsafe("it does not begin as an HDF5 file does")


def check_structure(path, unpacked=UNPACKED):
    """Refuse a file that may not be read as netCDF4; raises :class:`Unsafe`, FileNotFoundError, OSError.

    Chunks are unpacked until ``unpacked`` bytes are reached; math.inf: all.
    """
    check_file(path)
    import h5py

    unlocked = h5py.h5p.create(h5py.h5p.FILE_ACCESS)
    unlocked.set_file_locking(False, True)
    try:
        file = h5py.h5f.open(str(path).encode(), h5py.h5f.ACC_RDONLY, unlocked)
    except Exception as error:  # the library raises many kinds for a damaged file
        check_environment(path, error)
        raise Unsafe(f"the HDF5 library cannot open it: {error}") from error
    try:
        _Guard(h5py, file, Path(path), unpacked).check()
    except Unsafe:
        raise
    except Exception as error:
        check_environment(path, error)
        raise Unsafe(f"its structure is damaged: {type(error).__name__}: {error}") from error
    finally:
        file.close()


class _Guard:
    """One look through an open file; ``stored`` and ``declared`` are the bytes of its variables, packed and unpacked."""

    def __init__(self, h5py, file, path, unpacked):
        self.h5, self.file, self.path, self.unpacked = h5py, file, path, unpacked
        self.size, self.stored, self.declared, self.known, self.packed = path.stat().st_size, 0, 0, set(), []
        types = h5py.h5t
        self.kinds = [
            getattr(types, f"{family}{size}{order}")
            for family, sizes in (("STD_I", (8, 16, 32, 64)), ("STD_U", (8, 16, 32, 64)), ("IEEE_F", (32, 64)))
            for size in sizes
            for order in ("LE", "BE")
        ]

    def check(self):
        h5g = self.h5.h5g
        root = h5g.open(self.file, b"/")
        count = root.get_num_objs()
        if count > MOST_OBJECTS:
            raise Unsafe(f"it holds {count:,} objects, at most {MOST_OBJECTS} are allowed")
        self._attributes(root, "the file")
        for name in [*root]:
            self._link(root, name)
        if self.stored > self.size:
            raise Unsafe(f"its variables claim {self.stored:,} of its {self.size:,} bytes: some share their bytes")
        if self.declared > max(BOMB_BYTES, BOMB * self.size):
            raise Unsafe(
                f"it would unpack from {self.size:,} to {self.declared:,} bytes, more than {BOMB} times its size: a bomb,"
                " or an atlas without results"
            )
        skipped = [(offset, length) for _, _, offset, length in self.packed]
        if (place := damaged_heap(self.path, self.size, skipped)) is not None:
            raise Unsafe(f"its texts and references are damaged at byte {place:,}")
        self._unpack()

    def _unpack(self):
        """Chunks must hold what they declare; no more of them is unpacked than that."""
        with self.path.open("rb") as file:
            for shown, size, offset, length in self.packed:
                if self.unpacked <= 0:
                    return
                self.unpacked -= size
                file.seek(offset)
                if not _unpacks_to(size, file.read(length)):
                    raise Unsafe(f"{shown} has a chunk that is not packed from the {size:,} bytes that it declares")

    def _link(self, root, name):
        shown = f"{name.decode(errors='replace')!r:.60}"
        if root.links.get_info(name).type != self.h5.h5l.TYPE_HARD:
            raise Unsafe(f"{shown} is a link to elsewhere; an atlas holds its own variables")
        about = self.h5.h5o.get_info(root, name)
        if about.type != self.h5.h5o.TYPE_DATASET:
            raise Unsafe(f"{shown} is a group or a named type; an atlas holds variables only")
        if about.addr in self.known:
            raise Unsafe(f"{shown} is another variable by a second name")
        self.known.add(about.addr)
        variable = self.h5.h5d.open(root, name)
        self._variable(variable, name.decode(errors="replace"), shown)
        self._attributes(variable, shown)

    def _variable(self, variable, name, shown):
        made, h5d = variable.get_create_plist(), self.h5.h5d
        layout = made.get_layout()
        if layout not in (h5d.COMPACT, h5d.CONTIGUOUS, h5d.CHUNKED):
            raise Unsafe(f"{shown} is a virtual dataset: its numbers lie in other files")
        if made.get_external_count():
            raise Unsafe(f"{shown} has external storage: its numbers lie in other files")
        filters = [made.get_filter(k)[0] for k in range(made.get_nfilters())]
        h5z = self.h5.h5z
        names = {h5z.FILTER_DEFLATE: "deflate", h5z.FILTER_SHUFFLE: "shuffle"}
        pipeline = tuple(names.get(code, f"filter {code}") for code in filters)
        if pipeline not in PACKED:
            raise Unsafe(f"{shown} is packed by {', '.join(pipeline)}; allowed is deflate, after shuffle or alone")
        kind, space = variable.get_type(), variable.get_space()
        if space.get_simple_extent_type() not in (self.h5.h5s.SIMPLE, self.h5.h5s.SCALAR):
            raise Unsafe(f"{shown} holds nothing")
        shape = space.get_simple_extent_dims()
        count = math.prod(shape)
        if not 0 < count <= MOST_NUMBERS:
            raise Unsafe(f"{shown} declares {count:,} numbers; an atlas has 1 to {MOST_NUMBERS:,} of a variable")
        if name in LABELS and isinstance(kind, self.h5.h5t.TypeStringID) and kind.is_variable_str():
            return self._labels(variable, shape, layout, shown)
        if kind.committed() or not any(kind.equal(allowed) for allowed in self.kinds):
            raise Unsafe(f"{shown} holds no plain numbers but {_named(kind)}")
        size = count * kind.get_size()
        self.declared += size
        if layout == h5d.CHUNKED:
            return self._chunks(variable, made.get_chunk(), shape, kind.get_size(), bool(filters), shown)
        stored = variable.get_storage_size()
        self.stored += stored
        offset = variable.get_offset()
        inside = layout == h5d.COMPACT or (offset is not None and offset + size <= self.size)
        if stored != size or not inside:
            raise Unsafe(f"{shown} declares {size:,} bytes, {stored:,} are stored in this file")
        return None

    def _chunks(self, variable, chunk, shape, item, packed, shown):
        """Every chunk there, whole, in this file, of a size that can be unpacked."""
        size = math.prod(chunk) * item
        if size > CHUNK_BYTES:
            raise Unsafe(f"{shown} has chunks of {size:,} bytes, at most {CHUNK_BYTES:,} are allowed")
        wanted = math.prod(-(-have // of) for have, of in zip(shape, chunk))
        if (found := variable.get_num_chunks()) != wanted:
            raise Unsafe(f"{shown} declares {wanted:,} chunks, {found:,} are stored")
        most = size + size // 100 + 64 if packed else size  # deflate adds a little to what it cannot pack
        faults = []

        def look(one):
            self.stored += one.size
            if one.filter_mask or one.size > most or (not packed and one.size != size):
                faults.append("a chunk that is packed otherwise than it says")
            elif one.byte_offset is None or one.byte_offset + one.size > self.size:
                faults.append("a chunk beyond the end of the file")
            if packed:
                self.packed.append((shown, size, one.byte_offset, one.size))
            return faults[-1] if faults else None  # anything but None ends the round

        variable.chunk_iter(look)
        if faults:
            raise Unsafe(f"{shown} has {faults[0]}")

    def _labels(self, variable, shape, layout, shown):
        """Names of designs: the file holds 16 bytes for each, the first four its length, the others where it lies."""
        if len(shape) != 1 or shape[0] > MOST_LABELS or layout != self.h5.h5d.CONTIGUOUS:
            raise Unsafe(f"{shown} is no plain list of at most {MOST_LABELS:,} texts")
        offset = variable.get_offset()
        with self.path.open("rb") as file:
            file.seek(offset if offset is not None else self.size)
            content = file.read(16 * shape[0])
        longest = max((int.from_bytes(content[k : k + 4], "little") for k in range(0, len(content), 16)), default=0)
        if len(content) != 16 * shape[0] or longest > LABEL_BYTES:
            raise Unsafe(f"{shown} holds texts of more than {LABEL_BYTES} bytes, or none")

    def _attributes(self, thing, shown):
        h5a = self.h5.h5a
        count = h5a.get_num_attrs(thing)
        if count > MOST_OBJECTS:
            raise Unsafe(f"{shown} has {count:,} attributes, at most {MOST_OBJECTS} are allowed")
        for k in range(count):
            self._attribute(h5a.open(thing, index=k), shown)

    def _attribute(self, one, shown):
        h5t = self.h5.h5t
        name = one.name.decode(errors="replace")
        kind, space = one.get_type(), one.get_space()
        count = space.get_simple_extent_npoints()
        size = kind.get_size() * count
        if size > ATTRIBUTE_BYTES:
            raise Unsafe(
                f"attribute {name!r:.60} of {shown} has {size:,} bytes, at most {ATTRIBUTE_BYTES:,} are allowed"
            )
        if name in ATTACHED:
            good = kind.get_class() in (h5t.VLEN, h5t.COMPOUND) and count <= MOST_OBJECTS
        elif isinstance(kind, h5t.TypeStringID) and kind.is_variable_str():
            good = count == 1
        else:
            good = isinstance(kind, h5t.TypeStringID) or any(kind.equal(allowed) for allowed in self.kinds)
        if not good or kind.committed():
            raise Unsafe(f"attribute {name!r:.60} of {shown} is neither one text nor plain numbers but {_named(kind)}")


def _unpacks_to(size, content) -> bool:
    """Whether deflated bytes hold so many bytes; no more are ever unpacked."""
    stream = zlib.decompressobj()
    try:
        return len(stream.decompress(content, size + 1)) == size and stream.eof
    except zlib.error:
        return False


def _named(kind) -> str:
    """The class of an HDF5 type in a word."""
    return type(kind).__name__.removeprefix("Type").removesuffix("ID").lower() + f" of {kind.get_size():,} bytes"
