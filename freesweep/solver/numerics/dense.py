"""A few linear equations."""

from ...jit import kernel


@kernel
def swap(matrix, one, other):
    """Swap two rows."""
    for j in range(matrix.shape[1]):
        matrix[one, j], matrix[other, j] = matrix[other, j], matrix[one, j]


@kernel
def eliminate(matrix, right):
    """Gauss's elimination with the largest pivot of each column; the solutions (n, m) are left in ``right``."""
    n, columns = right.shape
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        swap(matrix, k, best)
        swap(right, k, best)
        for i in range(k + 1, n):
            share = matrix[i, k] / matrix[k, k]
            for j in range(k, n):
                matrix[i, j] -= share * matrix[k, j]
            for j in range(columns):
                right[i, j] -= share * right[k, j]
    for k in range(n - 1, -1, -1):
        for j in range(columns):
            for i in range(k + 1, n):
                right[k, j] -= matrix[k, i] * right[i, j]
            right[k, j] /= matrix[k, k]
