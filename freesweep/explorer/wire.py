"""How an answer travels to the page: a line of JSON that names arrays, then their bytes, each aligned for the browser."""

import json

import numpy as np

ALIGN = 8  # [bytes]


def pack(answer: dict) -> bytes:
    """``answer`` (what JSON knows, and NumPy arrays anywhere among its dictionaries and lists) as bytes."""
    arrays = []
    head = json.dumps(_lifted(answer, arrays), allow_nan=False, separators=(",", ":")).encode()
    head += b" " * (-(len(head) + 4) % ALIGN)
    parts = [len(head).to_bytes(4, "little"), head]
    for array in arrays:
        raw = array.tobytes()
        parts += [raw, b"\0" * (-len(raw) % ALIGN)]
    return b"".join(parts)


def _lifted(value, arrays):
    """The same with its arrays replaced by their place; numbers that JSON lacks become null."""
    if isinstance(value, dict):
        return {key: _lifted(one, arrays) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_lifted(one, arrays) for one in value]
    if isinstance(value, np.ndarray) and value.ndim > 0:
        kind = value.dtype if value.dtype.kind == "f" else np.uint8
        before = sum(one.nbytes + -one.nbytes % ALIGN for one in arrays)
        arrays.append(np.ascontiguousarray(value, kind))
        return {"array": np.dtype(kind).name, "at": before, "length": value.size}
    if isinstance(value, np.generic | np.ndarray):
        value = value.item()
    return None if isinstance(value, float) and not np.isfinite(value) else value
