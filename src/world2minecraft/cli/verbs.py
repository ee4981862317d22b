"""The verbs of ``w2m``: one line here, one file beside, imported when its verb is called.

A verb is a module ``world2minecraft.cli.NAME`` (``rooms scan`` is ``cli.rooms.scan``; the command
of a folder is ``cli.render.command``) with a function ``run`` whose typed parameters are its
arguments, as typer reads them, and a text ``EXAMPLES`` that its ``--help`` ends with. ``run``
returns an exit code, or None for 0.
"""

from collections.abc import Callable, Sequence
from importlib import import_module
from inspect import cleandoc, signature
from keyword import iskeyword
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from world2minecraft import __version__
from world2minecraft.cli.failures import STOPPED

VERBS: dict[str, str] = {
    "demo": "Try this first: a room is generated, scanned, built.",
    "scan": "Tell what a capture holds, before any long work.",
    "reconstruct": "Turn a capture into a Minecraft world, with a report.",
    "build": "Build a room: a world of its own, in yours, on a server.",
    "forge": "See every stage of a room in the browser, and mend it.",
    "forge stats": "Tell how much work edited rooms were.",
    "join": "Join finished runs of single rooms into one home.",
    "rooms generate": "Generate a furnished room or a house, with exact truth.",
    "rooms scan": "Scan a generated room or house with a virtual depth camera.",
    "evaluate reconstruction": "Score a reconstruction against a scanned room's truth.",
    "evaluate scannet": "Make a truth of a ScanNet scene of yours, to score runs by.",
    "occupy": "Say what each cell is: of a picture's grid, or of a captured room.",
    "train": "Train an occupancy network on any data sets.",
    "export": "Write a trained network as ONNX, which runs without torch.",
    "evaluate occupancy": "Score a network or saved predictions by the published protocols.",
    "dataset stats": "Tell what a data set holds, beside the paper's.",
    "dataset quality": "Measure how natural and how sharp pictures are.",
    "furniture list": "List the furniture that rooms are built of.",
    "furniture show": "Show one piece of furniture.",
    "furniture add": "Add a piece of your own from a schematic.",
    "furniture sheet": "Draw all furniture on one sheet.",
    "palettes": "List the palettes, or check one of your own.",
    "dataset map": "Tell what blocks of any world stand for; export the table.",
    "render": "Draw a build: pictures, depth, ids, walks and turntables.",
    "dataset export": "Write a data set as other loaders read it: NYUv2, OccScanNet ...",
    "dataset import": "Read NYUv2, OccScanNet and such into a data set of ours.",
    "dataset show": "Show one sample of any data set as a picture.",
    "convert": "Turn any form of a room or build into any other.",
    "clean": "Mend a built room as a person would.",
    "install": "Copy a built world to where the game finds it.",
    "undo": "Take back what was last built into a world.",
    "dataset build": "Make a labelled data set of generated houses, or of worlds of yours.",
    "dataset rooms": "Make a labelled data set of photo-like pictures of generated rooms.",
    "dataset verify": "Check every byte of a data set.",
    "dataset tour": "Plan which pictures of a world are taken, or take those of screenshots.",
    "dataset sheet": "Draw many pictures of a data set or a tour on one page.",
    "vln build": "Make navigation questions of walks through scenes.",
    "vln reword": "Let a navigation set ask in the words of people, or of a model.",
    "vln stats": "Tell what a navigation set holds, and what guessing scores.",
    "vln export": "Write navigation data as trainers and simulators read it.",
    "vln run": "Let an agent walk by an instruction: live, scored and on film.",
    "vln annotate": "Write instructions for walks of a set, on a page in the browser.",
    "vln server": "Check, and put in place, what a body on a game server needs.",
    "vln evaluate": "Ask a model the items of a navigation set.",
    "vln table": "Print the results of navigation runs side by side.",
    "compare layouts": "Score layouts of rooms, of other methods and ours, by one rule.",
    "compare build": "Build layouts of other methods as Minecraft worlds, faults and all.",
    "compare judge": "Let a vision-language model grade built rooms, all shown alike.",
    "compare describe": "Say a room in the words that text-to-layout methods start from.",
    "paper": "Print the paper's tables, with ours beside and how it was measured.",
    "paper figure": "Draw a room as the paper does: photo, world, cells, construction.",
    "doctor": "Check that this machine can run the program.",
}

# Verbs of one word whose folder holds more than the command.
FOLDERS = ("build", "forge", "paper", "render", "train")

# What stands in the help for a value that has no word of its own, by what its type says.
VALUE_WORDS = {"Path": "PATH", "str": "TEXT", "float": "X", "int": "N"}

EXAMPLES = """\
w2m demo                                  a room to OUT/, nothing needed
w2m scan my_scan                          what is in this folder?
w2m reconstruct my_scan --out OUT         the whole way
w2m install OUT                           the world comes into your game
w2m render OUT --tour --out walk.gif      a walk through it, as a picture that moves
w2m doctor                                check this machine
w2m convert house.schem worlds/house      a schematic becomes a world
"""


def call(words: Sequence[str]) -> int:
    """Run the command that ``words`` say and return its exit code."""
    result = typer.main.get_command(_app()).main(
        args=list(words), prog_name="w2m", standalone_mode=False
    )
    if result == STOPPED:  # typer turns an interrupt into this code; older ones raise it.
        raise KeyboardInterrupt
    return result if isinstance(result, int) else 0


class VerbCommand(TyperCommand):
    """A verb whose help ends with its examples, printed as they are written."""

    examples = ""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words; what is wrong with them is said with this verb's help to look at."""
        try:
            return super().parse_args(ctx, args)
        except Exception as error:
            wrong: Any = error
            if getattr(wrong, "ctx", ctx) is None:
                wrong.ctx = ctx
            raise

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return what follows the verb: names in capitals, in brackets what may be left out."""
        words = (
            (f"{one.metavar}" if one.required else f"[{one.metavar}]") + "..." * (one.nargs != 1)
            for one in self.params
            if one.param_type_name == "argument"
        )
        return ["[OPTIONS]", *words]

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments, then the options, each with its line."""
        for kind in ("argument", "option"):
            rows = [
                (one.metavar or record[0] if kind == "argument" else record[0], record[1])
                for one in self.get_params(ctx)
                if one.param_type_name == kind and (record := one.get_help_record(ctx))
            ]
            if rows:
                with formatter.section(f"{kind.capitalize()}s"):
                    formatter.write_dl(rows)

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the examples under the options."""
        _write_examples(formatter, self.examples)


class VerbGroup(TyperGroup):
    """The verbs that begin with ``prefix``, all for an empty one. Listing them imports none."""

    prefix = ""

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of the verbs."""
        return list(self._lines())

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Import the verb's module and make its command; the first of two words is a group."""
        name = f"{self.prefix}{cmd_name}"
        if name in VERBS:
            return load(name)
        return _family(name) if any(verb.startswith(f"{name} ") for verb in VERBS) else None

    def _lines(self) -> dict[str, str]:
        start = len(self.prefix)
        return {verb[start:]: VERBS[verb] for verb in VERBS if verb.startswith(self.prefix)}

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the verb that ``args`` begin with.

        Raises:
            UnknownNameError: there is none; the message suggests the nearest.
        """
        both = " ".join(args[:2])
        if len(args) > 1 and both in VERBS:
            # Its first word may be a verb of its own, which would take the second for a file.
            return both, load(both), args[2:]
        if self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            from world2minecraft.core.errors import UnknownNameError

            raise UnknownNameError("verb", f"{self.prefix}{args[0]}", VERBS)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the table of verbs from their lines here."""
        with formatter.section("Verbs"):
            formatter.write_dl(list(self._lines().items()))

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the examples under the table."""
        if not self.prefix:
            _write_examples(formatter, EXAMPLES)


def load(verb: str) -> Any:
    """Import a verb's module and return its command."""
    words = verb.split()
    module = import_module(_module_of(words))
    app = typer.Typer(rich_markup_mode=None, add_completion=False)
    app.command(name=words[-1], help=_help(verb, module.run), cls=VerbCommand)(module.run)
    command = typer.main.get_command(app)
    command.examples = module.EXAMPLES  # type: ignore[attr-defined]
    _name_values(command, module.run)
    return command


def _module_of(words: list[str]) -> str:
    parts = [f"{word}_" if iskeyword(word) else word.replace("-", "_") for word in words]
    if len(words) == 1 and words[0] in FOLDERS:
        parts.append("command")
    return ".".join(("world2minecraft.cli", *parts))


def _name_values(command: Any, function: Callable[..., Any]) -> None:
    """Give each argument and value its word in capitals, the same in help and errors."""
    told = signature(function).parameters
    for one in command.params:
        if one.param_type_name == "argument":
            word = (one.metavar or one.name.upper()).removesuffix("...")
            one.metavar = word[1:-1] if word[0] + word[-1] == "[]" else word
        elif one.metavar is None and not one.is_flag and one.name in told:
            kind = told[one.name].annotation  # Annotated[...], of which the type is the first.
            kind = str(kind.__origin__ if hasattr(kind, "__metadata__") else kind)
            one.metavar = next((VALUE_WORDS[part] for part in VALUE_WORDS if part in kind), None)


def _family(first: str) -> Any:
    """Return the group of the verbs that begin with a word; alone it shows its help."""
    app = typer.Typer(
        cls=VerbGroup, rich_markup_mode=None, add_completion=False, no_args_is_help=True
    )
    app.callback(help=f"The verbs that begin with {first}.")(_no_options)
    group = typer.main.get_command(app)
    group.name, group.prefix = first, f"{first} "  # type: ignore[attr-defined]
    return group


def _no_options() -> None:
    """Take nothing: a group's own help."""


def _help(verb: str, function: Callable[..., Any]) -> str:
    """Return the verb's line and what its docstring says after its first line, up to the Args."""
    details = cleandoc(function.__doc__ or "").partition("\n\n")[2]
    for section in ("Args:", "Raises:"):
        details = details.partition(section)[0]
    return f"{VERBS[verb]}\n\n{details.strip()}"


def _app() -> typer.Typer:
    app = typer.Typer(
        cls=VerbGroup, rich_markup_mode=None, add_completion=False, subcommand_metavar="VERB ..."
    )
    app.callback(help="Real rooms become Minecraft scenes.")(_global_options)
    return app


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"w2m {__version__}")
        raise typer.Exit()


def _global_options(
    _version: Annotated[
        bool,
        typer.Option(
            "--version", is_eager=True, callback=_show_version, help="Show the version and leave."
        ),
    ] = False,
    _traceback: Annotated[
        bool,
        typer.Option("--traceback", help="When something goes wrong, show where. Works anywhere."),
    ] = False,
) -> None:
    """Take the options that stand before the verb; both are acted on elsewhere."""


def _write_examples(formatter: Any, examples: str) -> None:
    with formatter.section("Examples"):
        for line in examples.strip().splitlines():
            formatter.write(f"  {line}\n")
