"""The parser of all commands: it suggests what was meant, shows examples, and prints scripts for completion."""

import argparse
import difflib
import sys

from .examples import EXAMPLES

FILES = (  # arguments that name files
    "atlas", "spec", "out", "data", "files", "points", "wishes", "picture", "map", "report", "html",
)  # fmt: skip
SHELLS = ("bash", "zsh", "tcsh")


class _Formatter(argparse.HelpFormatter):
    def _fill_text(self, text, width, indent):
        return text if text.startswith("examples:") else super()._fill_text(text, width, indent)


class Parser(argparse.ArgumentParser):
    """A parser whose errors name what was probably meant, and whose help ends with examples."""

    def __init__(self, *given, **named):
        super().__init__(*given, **named | {"formatter_class": _Formatter})
        lines = EXAMPLES.get(self.prog, ())
        if lines:
            self.epilog = "\n".join(["examples:", *(f"  {line}" for line in lines)])

    def _check_value(self, action, value):
        """Refuse what is no choice; the choices of commands are a mapping of names."""
        if action.choices is not None and value not in action.choices:
            known = list(map(str, action.choices))
            raise argparse.ArgumentError(
                action, f"invalid choice: {value!r:.60}; {_meant(str(value), known)}choose from {', '.join(known)}"
            )

    def parse_known_args(self, args=None, namespace=None):
        """Options that are unknown here are told here, with the option that was meant, before others are missed."""
        words = list(sys.argv[1:] if args is None else args)
        end = words.index("--") if "--" in words else len(words)
        if self._subparsers is not None:  # what follows a command is the command's
            end = next((k for k, word in enumerate(words[:end]) if not word.startswith("-")), end)
        known = [name for name in self._option_string_actions if name.startswith("--")]
        given = [word.partition("=")[0] for word in words[:end] if word.startswith("--")]
        unknown = [word for word in given if not any(name.startswith(word) for name in known)]
        if unknown:
            self.error(
                "; ".join(f"there is no option {word:.60}; {_meant(word, known)}".rstrip("; ") for word in unknown)
            )
        return super().parse_known_args(args, namespace)


def _meant(word, known):
    near = difflib.get_close_matches(word[:60], known, n=1, cutoff=0.6)
    return f"did you mean {near[0]}? " if near else ""


def ends_in(*suffixes):
    """A type of arguments: names of files that end in one of ``suffixes``, which say what is written."""

    def name(text):
        if not text.lower().endswith(suffixes):
            raise argparse.ArgumentTypeError(f"found {text!r:.60}; the suffix must be one of {', '.join(suffixes)}")
        return text

    return name


class Completion(argparse.Action):
    """Prints a script that completes commands, options and files: ``--print-completion bash``."""

    def __call__(self, parser, namespace, values, option_string=None):
        """Print it, and end."""
        try:
            import shtab
        except ImportError:
            parser.error("--print-completion needs shtab: pip install 'freesweep[completion]'")
        _mark(parser, shtab.FILE, _words())
        print(shtab.complete(parser, shell=values))
        parser.exit()


def _words():
    """What arguments may be beside their choices: by their names."""
    from ..atlas.schema import PARAMETERS, VARIABLES
    from ..description.material_library import materials
    from ..example import specifications
    from ..thesis.figures import FIGURES

    axes = {name: [*PARAMETERS, "design"] for name in ("axes", "over", "along", "each")}
    words = {"material": materials, "variable": VARIABLES, "example": specifications()}
    return axes | words | {"figures": [*FIGURES, "table-1", "claims"]}


def _mark(parser, kind, words):
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for own in action.choices.values():
                _mark(own, kind, words)
        elif action.dest in FILES:
            action.complete = kind
        elif action.dest in words:
            action.choices = list(words[action.dest])
