"""Heaps of texts and references in an HDF5 file, looked through before the library does: it walks a damaged one for ever.

A heap is ``GCOL``, version 1, its size; then objects, each with its number, its size and its bytes, in steps of eight. The
number 0 is free space, whose size counts from its own head: a free space of no size is where the library never arrives.
"""

SIGNATURE = b"GCOL\x01\x00\x00\x00"
HEAD = 16  # bytes of the head of a heap, and of each object
STEP = 8
PART = 1 << 22  # [bytes] looked through at a time, and at most in one heap: a text has less


def damaged_heap(path, size, skipped) -> int | None:
    """Where the first heap lies that cannot be walked to its end; None: there is none.

    Packed chunks, ``skipped`` as pairs (offset, length), hold no heaps; the rest of the file's ``size`` is read.
    """
    with path.open("rb") as file:
        for start, stop in _between(size, skipped):
            while start < stop:
                file.seek(start)
                content = file.read(min(PART, stop - start) + len(SIGNATURE) - 1)
                if (found := content.find(SIGNATURE)) < 0:
                    start += PART
                    continue
                start += found
                if not _walks(file, start, size):
                    return start
                start += len(SIGNATURE)
    return None


def _between(size, skipped):
    """Parts of the file (start, stop) that are not skipped."""
    start = 0
    for offset, length in sorted(skipped):
        if offset > start:
            yield start, offset
        start = max(start, offset + length)
    if start < size:
        yield start, size


def _walks(file, start, size):
    """Whether the objects of a heap fill it."""
    file.seek(start + len(SIGNATURE))
    length = int.from_bytes(file.read(8), "little")
    if not HEAD <= length <= min(PART, size - start):
        return False
    file.seek(start)
    heap, at = file.read(length), HEAD
    while length - at >= HEAD:
        number, own = int.from_bytes(heap[at : at + 2], "little"), int.from_bytes(heap[at + 8 : at + HEAD], "little")
        taken = own if number == 0 else HEAD + -(-own // STEP) * STEP
        if not HEAD <= taken <= length - at:
            return False
        at += taken
    return True
