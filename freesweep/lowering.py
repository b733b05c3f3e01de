"""Numba's step from its own code to LLVM's, without what is written only to be taken out again.

Numba keeps a variable in memory, stored and loaded as a whole with all arrays of a tuple, unless one block alone uses it.
Here one that is given its value once, in front of all its uses, is that value.

Every array counts its holders. Numba counts up when a variable takes an array, or a tuple of arrays, and down when it is
last used: of what a kernel is handed, and of the parts of it, the caller holds each one all along, so nobody counts here.
And where an array is looked for in a tuple, only members that have one are taken out, rather than every number of each.
"""

import contextlib

from numba.core import cgutils, ir, types
from numba.core.analysis import compute_cfg_from_blocks, compute_use_defs, must_use_alloca
from numba.core.lowering import Lower
from numba.core.runtime.context import NRTContext

PARTS = ("static_getitem", "getattr", "exhaust_iter")  # expressions that give a tuple or a member of it


def assigned_once(blocks) -> dict:
    """What each variable is that one place of a function gives a value."""
    given = {}
    for block in blocks.values():
        for one in block.find_insts(ir.Assign):
            given.setdefault(one.target.name, []).append(one.value)
    return {name: values[0] for name, values in given.items() if len(values) == 1}


def lent(once, typeof) -> set:
    """Names of those that stand all along for an argument or for a part of one."""
    names = {name for name, value in once.items() if isinstance(value, ir.Arg)}
    sources = {name: source for name, value in once.items() if (source := _whole(value, typeof))}
    while more := {name for name, source in sources.items() if source in names} - names:
        names |= more
    return names


def known_where_used(once, blocks) -> set:
    """Names of those of which every use lies behind that place, on any way: they need no place in memory."""
    flow, found = compute_use_defs(blocks), once.keys() - must_use_alloca(blocks)
    before = compute_cfg_from_blocks(blocks).dominators()
    born = {name: label for label, names in flow.defmap.items() for name in names}
    for label, names in flow.usemap.items():
        found -= {name for name in names if not born.get(name, label) < label or born[name] not in before[label]}
    return found


def _whole(value, typeof):
    """The name of that which a value is, or is taken from, if that is all."""
    if isinstance(value, ir.Var):
        return value.name
    if isinstance(value, ir.Expr) and value.op in PARTS and isinstance(typeof(value.value.name), types.BaseTuple):
        return value.value.name
    return None


def counted(context, builder, kind, value):
    """The counts of all arrays in a value: what ``NRTContext.get_meminfos`` gives."""
    models = context._context.data_model_manager
    model = models[kind]
    found = [(kind, model.get_nrt_meminfo(builder, value))] if model.has_nrt_meminfo() else []
    for member, get in model.traverse(builder):
        if models[member].contains_nrt_meminfo():
            found += counted(context, builder, member, get(value))
    return found


class KernelLower(Lower):
    """As Numba's, but for what is lent, and for what is known wherever it is used."""

    def _find_singly_assigned_variable(self):
        super()._find_singly_assigned_variable()
        once = assigned_once(self.blocks)
        self._lent = lent(once, self.typeof)
        plain = {name for name in once if not self._is_counted(name)}
        known = known_where_used(once, self.blocks) & (self._lent | plain)
        self._uncounted = self._lent | known
        self._singly_assigned_vars |= known

    def _is_counted(self, name):
        return self.context.data_model_manager[self.typeof(name)].contains_nrt_meminfo()

    def lower_inst(self, inst):
        if isinstance(inst, ir.Del) and inst.value in self._uncounted:
            return
        if isinstance(inst, ir.Assign) and inst.target.name in self._lent:
            with _no_counting():
                super().lower_inst(inst)
        else:
            super().lower_inst(inst)

    def alloca_lltype(self, name, lltype, datamodel=None):
        """Numba asks LLVM for the size of each variable, to tell a debugger."""
        return cgutils.alloca_once(self.builder, lltype, name=name, zfill=False)


@contextlib.contextmanager
def _no_counting():
    counting = NRTContext._call_incref_decref
    NRTContext._call_incref_decref = lambda *_: None
    try:
        yield
    finally:
        NRTContext._call_incref_decref = counting
