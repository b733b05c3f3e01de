"""Numba's compiler without what kernels never need: a third of the time that a first call waits otherwise.

Numba optimises each function together with all that it calls, and makes machine code of it, and then anew at each level
above. Here a kernel that other kernels call remains as LLVM reads it; an entry point links all that it needs, each
kernel once, and only that is optimised and made.

Kernels hold no closures, ``with``, ``raise`` or expressions of whole arrays, so the passes that look for those are left
out. What is handed to LLVM is shorter (:mod:`.lowering`). And which signature an operator takes for arguments of given
types, which Numba finds out by trying dozens of templates, is found out once in a process rather than at each of
thousands of places.
"""

import contextlib
import gc

from llvmlite.binding import Linkage
from numba.core import event, typed_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.runtime.context import NRTContext
from numba.core.types.functions import BaseFunction

from .lowering import KernelLower, counted

LEFT_OUT = {  # by name: other versions of Numba know other passes
    "WithLifting",
    "InlineClosureLikes",
    "RewriteDynamicRaises",
    "MakeFunctionToJitFunction",
    "FindLiterallyCalls",
    "LiteralUnroll",
    "LiteralPropagationSubPipelinePass",
    "InlineOverloads",
    "NopythonRewrites",
    "NoPythonSupportedFeatureValidation",
    "AnnotateTypes",
}
_signatures = {}  # (function, types of arguments) -> signature


_ask = BaseFunction.get_call_type


def _remembered(function, context, given, named):
    """The signature that one of Numba's own functions takes."""
    if named:
        return _ask(function, context, given, named)
    if (key := (function, given)) not in _signatures:
        _signatures[key] = _ask(function, context, given, named)
    return _signatures[key]


INSTEAD = (
    (BaseFunction, "get_call_type", _remembered),
    (NRTContext, "get_meminfos", counted),
    (event, "install_timer", lambda *_: contextlib.nullcontext()),  # each kernel's own, told of each call of LLVM
)


@contextlib.contextmanager
def _quick():
    """While a kernel is compiled with all that it calls, parts of Numba are replaced by quicker ones, and Python's
    garbage collector, which would look at a compiler's many objects over and over, waits.
    """
    if BaseFunction.get_call_type is _remembered:  # it is called by one that is compiled
        yield
        return
    collecting, before = gc.isenabled(), [getattr(owner, name) for owner, name, _ in INSTEAD]
    gc.disable()
    for owner, name, quicker in INSTEAD:
        setattr(owner, name, quicker)
    try:
        yield
    finally:
        for (owner, name, _), usual in zip(INSTEAD, before):
            setattr(owner, name, usual)
        if collecting:
            gc.enable()


class _Part(JITCodeLibrary):
    """The code of a kernel that other kernels call, as LLVM reads it, neither optimised nor made."""

    def finalize(self):
        self._finalized = True

    def _own_module(self):
        """Its functions as LLVM takes them even where, so far, nobody calls them: one that is called later comes but
        once.
        """
        module = super()._get_module_for_linking()
        for one in module.functions:
            if one.linkage == Linkage.linkonce_odr:
                one.linkage = Linkage.weak_odr
        return module

    def _get_module_for_linking(self):
        """This kernel and all that it calls, each once; last Numba's own functions, of which LLVM takes those that are
        called.
        """
        whole, waiting, seen = self._own_module().clone(), [*self._linking_libraries], {}
        while waiting:
            library = waiting.pop()
            if library not in seen:
                seen[library] = True
                if isinstance(library, _Part):
                    whole.link_in(library._own_module(), preserve=True)
                    waiting += library._linking_libraries
        for library in seen:
            if not isinstance(library, _Part):
                whole.link_in(library._get_module_for_linking(), preserve=True)
        return whole


class _Whole(JITCodeLibrary):
    """The code of a kernel that Python calls, and of all others that it needs, which no one calls from outside.

    Those keep no name, so LLVM may drop arguments, and what it has put in everywhere. Its linker takes the first
    function of a name, be it another library's own: code compiled later for the same kernel would call one that has
    fewer arguments.
    """

    def finalize(self):
        self._doors = {one.name for one in self.get_defined_functions()}
        super().finalize()

    def _optimize_final_module(self):
        for one in self.get_defined_functions():
            if one.name not in self._doors and one.name.startswith("_ZN"):  # of Python's; Numba's own count references
                one.linkage = "private"
        super()._optimize_final_module()


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lowering(typed_passes.NativeLowering):
    """LLVM code, and machine code."""

    _name = "kernel_lowering"

    @property
    def lowering_class(self):
        return KernelLower

    def run_pass(self, state):
        state.library = _Whole(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return super().run_pass(state)


@register_pass(mutates_CFG=True, analysis_only=False)
class _PartLowering(typed_passes.NativeLowering):
    """LLVM code that no one but other kernels will call: no machine code of its own."""

    _name = "part_lowering"

    @property
    def lowering_class(self):
        return KernelLower

    def run_pass(self, state):
        state.library = _Part(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        super().run_pass(state)
        made = state["cr"]
        state.targetctx.insert_user_function(state.library, made.fndesc, [state.library])
        state["cr"] = made._replace(cfunc=state.library)
        return True


class KernelCompiler(CompilerBase):
    """The compiler of what Python calls."""

    lowering = _Lowering

    def compile_extra(self, function):
        with _quick():
            return super().compile_extra(function)

    def define_pipelines(self):
        whole = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager = type(whole)("kernel")
        for kind, words in whole.passes:
            if kind.__name__ not in LEFT_OUT:
                manager.add_pass(self.lowering if kind is typed_passes.NativeLowering else kind, words)
        manager.finalize()
        return [manager]


class PartCompiler(KernelCompiler):
    """The compiler of what kernels call."""

    lowering = _PartLowering
