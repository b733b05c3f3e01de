"""Numba's compiler without what kernels never need: a third of the time that a first call waits otherwise.

Numba optimises each function together with all that it calls, and makes machine code of it, and then anew at each level
above. Here a kernel that other kernels call remains as LLVM reads it; an entry point links all that it needs, each kernel
once, and only that is optimised and made.

Kernels hold no closures, ``with``, ``raise`` or expressions of whole arrays, so the passes that look for those are left out.
And which signature an operator takes for arguments of given types, which Numba finds out by trying dozens of templates, is
found out once in a process rather than at each of thousands of places.
"""

import gc

from numba.core import typed_passes, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass

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


class _Remembering:
    """A typing context that remembers the signatures of Numba's own functions."""

    def __init__(self, context):
        self._context = context

    def __getattr__(self, name):
        return getattr(self._context, name)

    def resolve_function_type(self, function, given, named):
        if named or not isinstance(function, types.Function):
            return self._context.resolve_function_type(function, given, named)
        if (key := (function, given)) not in _signatures:
            _signatures[key] = self._context.resolve_function_type(function, given, named)
        return _signatures[key]


@register_pass(mutates_CFG=True, analysis_only=False)
class _TypeInference(typed_passes.NopythonTypeInference):
    _name = "remembering_type_inference"

    def run_pass(self, state):
        context = state.typingctx
        state.typingctx = _Remembering(context)
        try:
            return super().run_pass(state)
        finally:
            state.typingctx = context


class _Part(JITCodeLibrary):
    """The code of a kernel that other kernels call, as LLVM reads it, neither optimised nor made."""

    def finalize(self):
        self._finalized = True

    def _own_module(self):
        return super()._get_module_for_linking()

    def _get_module_for_linking(self):
        """This kernel and all that it calls, each once."""
        whole, waiting, seen = self._own_module().clone(), [*self._linking_libraries], set()
        while waiting:
            library = waiting.pop()
            if library not in seen:
                seen.add(library)
                part = isinstance(library, _Part)
                whole.link_in(library._own_module() if part else library._get_module_for_linking(), preserve=True)
                waiting += library._linking_libraries if part else ()
        return whole


@register_pass(mutates_CFG=True, analysis_only=False)
class _PartLowering(typed_passes.NativeLowering):
    """LLVM code that no one but other kernels will call: no machine code of its own."""

    _name = "part_lowering"

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

    lowering = typed_passes.NativeLowering

    def compile_extra(self, function):
        """Python's garbage collector looks at a compiler's many objects over and over: it waits."""
        collecting = gc.isenabled()
        gc.disable()
        try:
            return super().compile_extra(function)
        finally:
            if collecting:
                gc.enable()

    def define_pipelines(self):
        whole = DefaultPassBuilder.define_nopython_pipeline(self.state)
        instead = {typed_passes.NopythonTypeInference: _TypeInference, typed_passes.NativeLowering: self.lowering}
        manager = type(whole)("kernel")
        for kind, words in whole.passes:
            if kind.__name__ not in LEFT_OUT:
                manager.add_pass(instead.get(kind, kind), words)
        manager.finalize()
        return [manager]


class PartCompiler(KernelCompiler):
    """The compiler of what kernels call."""

    lowering = _PartLowering
