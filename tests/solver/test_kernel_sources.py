"""What makes Numba compile for nothing is kept out of the kernels: more code for a literal, messages that nobody reads."""

import ast
from pathlib import Path

import numba
import pytest

import freesweep
from freesweep import jit

PACKAGE = Path(freesweep.__file__).parent
POLICIES = {"kernel", "in_place", "entry_point"}
FIRST = 1


@jit.kernel
def added(a, b, places, sign):
    return a + b + places[0] + places[1] if sign else a - b


@numba.njit
def calls(n, yes):
    literal = added(0, FIRST, (n, 2), True)
    return literal + added(n, -1, (0, n), yes) + added(n, n, (n, n), sign=False)


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
def test_a_literal_makes_no_machine_code_of_its_own():
    assert calls(5, True) == (1 + 5 + 2) + (5 - 1 + 5) + 0
    assert len(added.signatures) == 1
    assert added(1.0, 2.0, (3, 4), True) == 10.0  # from Python: machine code of its own
    assert len(added.signatures) == 1


def kernels(tree):
    """Definitions of kernels in a module."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            if any(isinstance(name, ast.Name) and name.id in POLICIES for name in node.decorator_list):
                yield node


def copies(function):
    """Assignments ``a[:] = b`` in a kernel; of a number or NaN they cost nothing."""
    for node in ast.walk(function):
        for target in node.targets if isinstance(node, ast.Assign) else ():
            pairs = [(target, node.value)]
            if isinstance(target, ast.Tuple):
                given = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value] * len(target.elts)
                pairs = zip(target.elts, given)
            for left, right in pairs:
                sliced = isinstance(left, ast.Subscript) and any(isinstance(n, ast.Slice) for n in ast.walk(left.slice))
                number = isinstance(right, ast.Constant) or (isinstance(right, ast.Attribute) and right.attr == "nan")
                if sliced and not number:
                    yield f"{node.lineno}: {ast.unparse(node)}"


def test_no_kernel_copies_an_array_by_slices():
    """Numba compiles the message for arrays that do not fit for each of them: four seconds where a loop takes none."""
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in PACKAGE.rglob("*.py")}
    found = [(path, kernel) for path, tree in trees.items() for kernel in kernels(tree)]
    assert len(found) > 100
    wrong = [f"{path.relative_to(PACKAGE)}, line {fault}" for path, kernel in found for fault in copies(kernel)]
    assert not wrong, "\n".join(["loops instead:", *wrong])


def test_copies_by_slices_are_found():
    (kernel,) = kernels(ast.parse("@kernel\ndef f(a, b):\n a[:] = b\n a[1:], n = b, 1\n a[:] = 0.0\n a[0] = b[0]\n"))
    assert len(list(copies(kernel))) == 2


def given_by_name(tree):
    """Kernels of a module that one of them hands to another one by their bare names."""
    own = {kernel.name for kernel in kernels(tree)}
    for kernel in kernels(tree):
        names = [node for node in ast.walk(kernel) if isinstance(node, ast.Name)]
        local = {one.arg for one in kernel.args.args} | {name.id for name in names if isinstance(name.ctx, ast.Store)}
        for call in (node for node in ast.walk(kernel) if isinstance(node, ast.Call)):
            for given in call.args:
                if isinstance(given, ast.Name) and given.id in own - local:
                    yield f"{call.lineno}: {ast.unparse(call)}"


def test_kernels_are_given_to_kernels_by_their_modules():
    """Given by its bare name one is an address of this process: all that uses it would be compiled in each process anew."""
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in PACKAGE.rglob("*.py")}
    wrong = [
        f"{path.relative_to(PACKAGE)}, line {fault}" for path, tree in trees.items() for fault in given_by_name(tree)
    ]
    assert not wrong, "\n".join(["by their modules, as lagrangian.density, instead:", *wrong])


def test_kernels_given_by_bare_names_are_found():
    tree = ast.parse("@kernel\ndef f(g, a):\n return g(a)\n@kernel\ndef h(a):\n b = f(h, a)\n return f(o.h, b)\n")
    assert len(list(given_by_name(tree))) == 1
