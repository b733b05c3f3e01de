"""Writes an atlas part by part in bounded memory: netCDF4 makes the empty file, chunks go in compressed.

The netCDF library hides a full disk. So it makes the structure in memory; h5py adds the chunks through a file object of
ours, which sees every fault; each chunk is read back before the file appears.
"""

import math
import struct
import zlib
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from io import SEEK_END
from itertools import product

import numpy as np

from . import netcdf
from .files import WholeFile
from .schema import attributes
from .seal import seal
from .store import FORMAT

CHUNK = 1 << 16  # numbers in one chunk
LEVEL = 1  # higher ones gain 3 %
PIECE, NOISE = 4096, 0.85  # bytes that are tried, and the share of them that is not worth deflating
ZLIB, RAW, LAST_BLOCK = b"\x78\x01", -15, b"\x03\x00"  # head of a zlib stream, blocks without one, an empty last block
STORED, STORED_BLOCK = (1 << 16) - 1, struct.Struct("<BHH")  # most bytes of a block that is not packed, and its head


def chunks_of(shape) -> tuple:
    """Shape of the chunks of a variable: whole trailing dimensions, part of one, single entries before it."""
    chunks, most = [], CHUNK
    for size in reversed(shape):
        chunks.append(-(-size // -(-size // most)))
        most = max(1, most // size)
    return tuple(reversed(chunks))


def parts(shape):
    """``(offset, first, last + 1)`` of each chunk of a variable, the latter counted in C order over all entries."""
    chunks = chunks_of(shape)
    strides = [math.prod(shape[k + 1 :]) for k in range(len(shape))]
    for offset in product(*(range(0, size, chunk) for size, chunk in zip(shape, chunks))):
        first = sum(place * stride for place, stride in zip(offset, strides))
        inner = [min(chunk, size - place) for place, size, chunk in zip(offset, shape, chunks)]
        yield offset, first, first + math.prod(inner)


def packed(array, shape) -> bytes:
    """Bytes of one chunk of a variable of that shape, as HDF5 stores them: shuffled, then deflated.

    The last bytes of doubles are noise, on which deflating spends most of its time to gain nothing: they go in as stored
    blocks of the same zlib stream, which any reader takes.
    """
    size, item = math.prod(chunks_of(shape)), array.dtype.itemsize
    content = np.zeros((item, size), np.uint8)
    content[:, : array.size] = np.ascontiguousarray(array).reshape(-1).view(np.uint8).reshape(-1, item).T
    if size <= PIECE:
        return zlib.compress(content, LEVEL)
    pieces = [ZLIB]
    for plane, noise in zip(content, _noisy(content)):
        pieces += _stored(plane) if noise else _deflated(plane)
    return b"".join([*pieces, LAST_BLOCK, zlib.adler32(content).to_bytes(4, "big")])


def _noisy(planes):
    """Which planes of bytes (item, n) hardly become smaller: looked for from the last ones, the first of a number, on."""
    found = [False] * len(planes)
    for k in reversed(range(len(planes))):
        if _is_noise(planes[k]):
            found[k] = True
            found[:k] = [True] * k if _is_noise(planes[0]) else [_is_noise(plane) for plane in planes[:k]]
            break
    return found


def _is_noise(plane) -> bool:
    """Whether a piece from the middle of a plane of bytes (n,) hardly becomes smaller."""
    begin = (len(plane) - PIECE) // 2
    piece = plane[begin : begin + PIECE]
    return len(zlib.compress(piece, LEVEL)) > NOISE * len(piece)


def _deflated(plane):
    """Blocks of a zlib stream that hold a plane of bytes, and end where a byte does."""
    packer = zlib.compressobj(LEVEL, zlib.DEFLATED, RAW)
    return packer.compress(plane), packer.flush(zlib.Z_SYNC_FLUSH)


def _stored(plane):
    """Blocks of a zlib stream that hold a plane of bytes as it is."""
    content = memoryview(plane)
    for begin in range(0, len(content), STORED):
        block = content[begin : begin + STORED]
        yield STORED_BLOCK.pack(0, len(block), len(block) ^ 0xFFFF)
        yield block


class AtlasWriter:
    """An atlas in the making: ``put`` its chunks, then ``publish`` it.

    ``sizes`` maps dimensions to their sizes, ``coordinates`` and ``variables`` names to (dimensions, values) and to
    (dimensions, dtype). Raises :class:`freesweep.atlas.files.EnvironmentFault`.
    """

    def __init__(self, path, sizes, coordinates, variables, attrs, needed=0):
        import h5py

        self.sums, self.store = {}, None
        self.file = WholeFile(path, needed)
        try:
            content = _skeleton(sizes, coordinates, variables, attrs)
            self.file.write(content)
            self.file.check()
            self.file.check_content(content)
            self.store = h5py.File(self.file, "r+")
            self.variables = {name: self.store[name] for name in variables}
        except BaseException as error:
            self.__exit__(type(error))  # what stays open HDF5 closes after Python's end, and with it the process
            raise

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        try:
            self._close()
        finally:
            self.file.discard()
        if kind is not None and issubclass(kind, Exception):
            self.file.check()  # what HDF5 stumbled over

    def put(self, name, offset, content):
        """Store one chunk, ``packed``; of a variable without dimensions, the number itself."""
        self.sums[name, offset] = zlib.crc32(content)
        if offset == ():
            self.variables[name][()] = content
        else:
            self.variables[name].id.write_direct_chunk(offset, content)
        self.file.check()

    def dataset(self):
        """What was put so far as an xarray Dataset, read when it is used; close it before the file is published."""
        self.store.flush()
        self.file.check()
        return netcdf.dataset(self.file.temporary)

    @contextmanager
    def misread(self):
        """What netCDF4 cannot read of the :meth:`dataset`, which it was told to write, is the disk's fault."""
        try:
            yield
        except RuntimeError as error:
            if "NetCDF" not in str(error):
                raise
            self.file.check()
            raise self.file.misread() from None

    def describe(self, attrs):
        """Add attributes of the atlas: name -> text."""
        for name, value in attrs.items():
            self.store.attrs[name] = value
        self.file.check()

    def publish(self, replace=True):
        """Finish the file, read it back, and let it appear; without ``replace`` only where no file is: FileExistsError."""
        self._close()
        self.file.check()
        with ThreadPoolExecutor(1) as aside:
            digest = aside.submit(self.file.digest)
            if not self._is_as_written():
                self.file.check()
                raise self.file.misread()
        last = seal(digest.result())
        place = self.file.seek(0, SEEK_END)
        self.file.write(last)
        self.file.check()
        self.file.seek(place)
        if self.file.read(len(last) + 1) != last:
            self.file.check()
            raise self.file.misread()
        self.file.publish(replace)

    def _is_as_written(self):
        """Whether every part is read back as it was put in."""
        import h5py

        try:
            with h5py.File(self.file, "r") as store:
                found = {name: store[name] for name in self.variables}
                return all(
                    zlib.crc32(_part(found[name], offset)) == known for (name, offset), known in self.sums.items()
                )
        except Exception:  # whatever the HDF5 library makes of a broken structure
            return False

    def _close(self):
        if self.store is not None:
            store, self.store = self.store, None
            try:
                store.close()
            except Exception:  # after a fault HDF5 may meet what it wrote half
                self.file.check()
                raise self.file.misread() from None


def _part(variable, offset):
    return variable[()] if offset == () else variable.id.read_direct_chunk(offset)[1]


def _skeleton(sizes, coordinates, variables, attrs) -> bytes:
    """An atlas without its numbers, a netCDF4 file in memory."""
    import netCDF4

    file = netCDF4.Dataset("atlas.nc", "w", memory=1 << 16)
    for name, size in sizes.items():
        file.createDimension(name, size)
    beside = {name: dims for name, (dims, _) in coordinates.items() if dims != (name,)}
    for name, (dims, values) in coordinates.items():
        kind = str if np.asarray(values).dtype == object else np.asarray(values).dtype
        variable = file.createVariable(name, kind, dims, fill_value=False)
        variable[...] = values
        _describe(variable, name)
    for name, (dims, dtype) in variables.items():
        chunked = {"chunksizes": chunks_of([sizes[each] for each in dims])} if dims else {}
        packing = {"compression": "zlib", "complevel": LEVEL, "shuffle": True} if dims else {}
        variable = file.createVariable(name, dtype, dims, fill_value=False, **packing, **chunked)
        _describe(variable, name)
        own = [each for each, others in beside.items() if set(others) <= set(dims)]
        if own:
            variable.setncattr("coordinates", " ".join(own))
    for name, value in (attrs | {"freesweep_format": FORMAT}).items():
        file.setncattr(name, value)
    return bytes(file.close())


def _describe(variable, name):
    for key, value in attributes(name).items() if name != "design" else ():
        variable.setncattr(key, np.array(value, "i1") if isinstance(value, list) else value)
