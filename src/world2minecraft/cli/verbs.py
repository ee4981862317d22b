"""Table of the verbs of ``w2m``, and the code that loads the module of a verb when it is called.

A verb is a module ``world2minecraft.cli.NAME`` (``rooms scan`` is ``cli.rooms.scan``, and the
command of a folder is ``cli.render.command``). It has a function ``run``, whose typed parameters
typer reads as arguments and options, and a text ``EXAMPLES`` for its help. ``run`` returns an exit
code, or None for 0. Options declared with ``cli.panels.MORE`` are listed in a separate section.
"""

import os
import re
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from inspect import cleandoc, signature
from keyword import iskeyword
from shutil import get_terminal_size
from typing import Annotated, Any, NamedTuple

import typer
from typer.core import TyperCommand, TyperGroup

from world2minecraft import __version__
from world2minecraft.cli.failures import STOPPED
from world2minecraft.cli.json_output import complete_json_option
from world2minecraft.cli.panels import MORE, more_option
from world2minecraft.core.locks import wait_for_locks

# The verbs under the headings of ``w2m --help``, each with its one-line summary.
VERB_GROUPS: dict[str, dict[str, str]] = {
    "Start": {
        "demo": "Generate a room, scan it virtually and build it as a world.",
        "scan": "Show what a capture contains, without reconstructing it.",
        "reconstruct": "Convert a capture to a Minecraft world with a report.",
        "install": "Copy a built world into the game's saves folder.",
        "share": "Write a room as one file to send: a page or a film.",
        "doctor": "Check that this machine can run the program.",
    },
    "Reconstruct": {
        "segment": "Name what each pixel of a capture's pictures shows.",
        "join": "Join reconstructions of single rooms to one home.",
        "convert": "Convert between rooms, builds, worlds, schematics and 3D files.",
        "render": "Render a build as images, depth maps, walks and turntables.",
    },
    "Edit": {
        "forge": "Open the SceneForge editor in the browser.",
        "forge stats": "Report the editing effort of rooms.",
        "build": "Build a room as a new world, into a world or on a server.",
        "clean": "Repair typical reconstruction errors in a built room.",
        "undo": "Undo the last build into a world.",
    },
    "Generate": {
        "rooms generate": "Generate a furnished room or house with exact ground truth.",
        "rooms scan": "Scan a generated room or house with a virtual depth camera.",
    },
    "Data sets": {
        "dataset build": "Build a labelled data set of generated houses or worlds.",
        "dataset rooms": "Build a labelled data set of photo-like images of rooms.",
        "dataset tour": "Plan views of a world, or read screenshot poses.",
        "dataset map": "Show how blocks are labelled, and export the table.",
        "dataset stats": "Summarise a data set next to the paper's results.",
        "dataset quality": "Measure the naturalness and sharpness of images.",
        "dataset show": "Draw one sample of a data set.",
        "dataset sheet": "Draw a contact sheet of a data set or a tour.",
        "dataset verify": "Verify all files of a data set, and repair them.",
        "dataset export": "Export a data set to NYUv2, OccScanNet or other formats.",
        "dataset import": "Import NYUv2, OccScanNet and similar data sets.",
    },
    "Networks": {
        "train": "Train an occupancy network on one or more data sets.",
        "export": "Export a trained network to ONNX.",
        "occupy": "Predict the class of each cell in an image or room.",
        "evaluate occupancy": "Score predictions with the published protocols.",
    },
    "Navigation": {
        "vln build": "Build navigation tasks from walks through scenes.",
        "vln reword": "Rephrase the instructions of a navigation set.",
        "vln annotate": "Write instructions for walks in the browser.",
        "vln stats": "Summarise a navigation set, with baseline scores.",
        "vln verify": "Verify all files of a navigation set, and repair them.",
        "vln export": "Export navigation data for trainers and simulators.",
        "vln run": "Run an agent on an instruction, with scores and video.",
        "vln evaluate": "Evaluate a model on the items of a navigation set.",
        "vln table": "Print the results of navigation runs side by side.",
        "vln server": "Check and prepare a game server for an agent.",
    },
    "Evaluate": {
        "evaluate reconstruction": "Score a reconstruction against ground truth.",
        "evaluate sscnet": "Score the completion of one frame by SSCNet's protocol.",
        "evaluate scannet": "Create ground truth from a ScanNet scene.",
        "compare layouts": "Score room layouts from this and other methods.",
        "compare build": "Build layouts of other methods as worlds.",
        "compare judge": "Grade rooms with a vision-language model.",
        "compare describe": "Describe a room for text-to-layout methods.",
        "paper": "Print the paper's tables next to our results.",
        "paper figure": "Draw a room like the figures of the paper.",
    },
    "Tools": {
        "furniture list": "List the furniture templates.",
        "furniture show": "Show one furniture template.",
        "furniture add": "Add a furniture template from a schematic.",
        "furniture sheet": "Draw all furniture templates, a page per class.",
        "palettes": "List the block palettes, or check a palette file.",
        "settings": "List the keys of --set with units, defaults and meanings.",
        "completion": "Print a script that completes w2m commands in a shell.",
    },
}
VERBS: dict[str, str] = {
    verb: summary for group in VERB_GROUPS.values() for verb, summary in group.items()
}

# First words of two-word verbs, with the summaries for their help.
FAMILIES = {
    "compare": "Compare rooms with those of other methods.",
    "dataset": "Build, inspect and exchange occupancy data sets.",
    "evaluate": "Score reconstructions and networks against ground truth.",
    "furniture": "Inspect and extend the library of furniture templates.",
    "rooms": "Generate rooms and houses, and scan them virtually.",
    "vln": "Build, run and score vision-language navigation.",
}

# One-word verbs whose folder contains more modules than the command.
FOLDERS = ("build", "forge", "paper", "render", "train")

# Verbs with the option --wait, which write folders that another process may write.
WAITING_VERBS = frozenset((
    "build", "clean", "compare build", "convert", "dataset build", "dataset export",
    "dataset import", "dataset rooms", "dataset verify", "demo", "join", "occupy", "reconstruct",
    "render", "rooms generate", "rooms scan", "segment", "train", "undo", "vln build",
    "vln evaluate", "vln export", "vln reword", "vln run", "vln verify",
))  # fmt: skip

# A shell completion script sets this variable to request names.
COMPLETE_VARIABLE = "_W2M_COMPLETE"

IMPLIED_DEFAULT = re.compile(r"\[default: \((.+?)\)\]")  # Typer's form of show_default texts.
EXAMPLE = re.compile(r"(\s*\S.*?)(\s{2,})(\S.*)")  # A command and its description.
# The placeholder of a value without a metavar, by its type.
VALUE_WORDS = {"Path": "PATH", "str": "TEXT", "float": "X", "int": "N"}

EXAMPLES = """\
w2m demo                                  build a generated room in OUT/
w2m scan my_scan                          show what a capture contains
w2m reconstruct my_scan --out OUT         turn it into a world
w2m install OUT                           copy the world into the game
w2m render OUT --tour --out walk.gif      render a walk through it
w2m convert house.schem worlds/house      convert a schematic into a world
"""


def call(words: Sequence[str]) -> int:
    """Run the command given by ``words`` and return its exit code."""
    if COMPLETE_VARIABLE in os.environ:
        from typer.completion import completion_init  # type: ignore[attr-defined]

        completion_init()
    result = typer.main.get_command(_app()).main(
        args=list(words), prog_name="w2m", standalone_mode=False
    )
    if result == STOPPED:  # typer turns an interrupt into this code; older ones raise it.
        raise KeyboardInterrupt
    return result if isinstance(result, int) else 0


class Completion(NamedTuple):
    """A candidate for the completion of a word, in the form that typer expects."""

    value: str
    help: str
    type: str = "plain"


def complete_verbs(prefix: str, beginning: str) -> list[Any]:
    """Return the words that can follow ``prefix`` in a verb, without importing any verb.

    Example:
        >>> [one.value for one in complete_verbs("rooms ", "")]
        ['generate', 'scan']
    """
    start = f"{prefix}{beginning}"
    words = {}
    for verb in (verb for verb in VERBS if verb.startswith(start)):
        word = verb[len(prefix) :].partition(" ")[0]
        name = f"{prefix}{word}"
        words[word] = Completion(word, VERBS.get(name) or FAMILIES.get(name, ""))
    return list(words.values())


class VerbCommand(TyperCommand):
    """The command of a verb.

    Its help shows arguments, options and examples first, and the options in the panel ``MORE``
    last.
    """

    examples = ""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments. Usage errors refer to the help of this verb."""
        try:
            return super().parse_args(ctx, complete_json_option(args, self.params))
        except Exception as error:
            wrong: Any = error
            if getattr(wrong, "ctx", ctx) is None:
                wrong.ctx = ctx
            raise

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the arguments in capitals, with optional arguments in brackets."""
        words = (
            (f"{one.metavar}" if one.required else f"[{one.metavar}]") + "..." * (one.nargs != 1)
            for one in self.params
            if one.param_type_name == "argument"
        )
        return ["[OPTIONS]", *words]

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments, then the options that are not in the panel ``MORE``."""
        self._write_section(ctx, formatter, "Arguments", "argument")
        self._write_section(ctx, formatter, "Options", "option")

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the examples, then the options of the panel ``MORE``."""
        _write_examples(formatter, self.examples)
        self._write_section(ctx, formatter, MORE, "option")

    def _write_section(self, ctx: Any, formatter: Any, heading: str, kind: str) -> None:
        rows = [
            (
                one.metavar or record[0] if kind == "argument" else record[0],
                IMPLIED_DEFAULT.sub(r"[default: \1]", record[1]),
            )
            for one in self.get_params(ctx)
            if one.param_type_name == kind
            and (getattr(one, "rich_help_panel", None) == MORE) == (heading == MORE)
            and (record := one.get_help_record(ctx))
        ]
        if rows:
            with formatter.section(heading):
                formatter.write_dl(rows)


class VerbGroup(TyperGroup):
    """All verbs, or the verbs that start with ``prefix``. Listing them imports no module."""

    prefix = ""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments, or show the help if there are none."""
        return super().parse_args(ctx, args or ["--help"])

    def shell_complete(self, ctx: Any, incomplete: str) -> list[Any]:
        """Return the matching verbs, or options if the word starts with a dash."""
        own = self.prefix.strip()
        if own in VERBS and not incomplete[:1].isalnum():
            return load(own).shell_complete(ctx, incomplete)
        if incomplete.startswith("-"):
            return super().shell_complete(ctx, incomplete)
        return complete_verbs(self.prefix, incomplete)

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of the verbs."""
        return list(self._summaries())

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return the command of a verb, or the group of verbs that start with a word."""
        name = f"{self.prefix}{cmd_name}"
        if name in VERBS:
            return load(name)
        return _family(cmd_name, self.prefix)

    def _summaries(self) -> dict[str, str]:
        start = len(self.prefix)
        return {verb[start:]: VERBS[verb] for verb in VERBS if verb.startswith(self.prefix)}

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the verb at the start of ``args``.

        Raises:
            UnknownNameError: If the verb is unknown. The message suggests the closest match.
        """
        both = " ".join(args[:2])
        if len(args) > 1 and both in VERBS:
            # Its first word may be a verb of its own, which would take the second for a file.
            return both, load(both), args[2:]
        if ctx.resilient_parsing and len(args) == 1 and (group := _family(args[0], self.prefix)):
            return args[0], group, []  # A shell may complete "forge st" to "forge stats".
        if self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            if ctx.resilient_parsing:  # A shell completes a word after an unknown one.
                return None, None, args
            from world2minecraft.core.errors import UnknownNameError

            raise UnknownNameError("verb", f"{self.prefix}{args[0]}", VERBS)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the verbs with their summaries, grouped under headings."""
        if self.prefix:
            with formatter.section("Verbs"):
                formatter.write_dl(list(self._summaries().items()))
            return
        for heading, summaries in VERB_GROUPS.items():
            with formatter.section(heading):
                formatter.write_dl(_indent_families(summaries))

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the examples below the table of verbs."""
        if not self.prefix:
            _write_examples(formatter, EXAMPLES)


def _indent_families(summaries: dict[str, str]) -> list[tuple[str, str]]:
    """Return rows of (verb, summary) in which the first word of a family is shown only once.

    After ``rooms generate``, for example, the verb ``rooms scan`` is shown as ``      scan``.
    """
    rows, previous = [], ""
    for verb, summary in summaries.items():
        first, _, second = verb.partition(" ")
        name = " " * len(first) + f" {second}" if second and first == previous else verb
        rows.append((name, summary))
        previous = first
    return rows


def load(verb: str) -> Any:
    """Import the module of a verb and return its command."""
    words = verb.split()
    module = import_module(_module_of(words))
    app = typer.Typer(rich_markup_mode=None, add_completion=False)
    app.command(name=words[-1], help=_help(verb, module.run), cls=VerbCommand)(module.run)
    command = typer.main.get_command(app)
    command.examples = module.EXAMPLES  # type: ignore[attr-defined]
    if verb in WAITING_VERBS:
        command.params.append(_wait_option())
    _name_values(command, module.run)
    return command


def _wait_option() -> Any:
    """Return the option ``--wait``, with which a command waits for the locks of other processes."""

    def wait(ctx: typer.Context, is_given: bool) -> None:
        if is_given and not ctx.resilient_parsing:
            ctx.with_resource(wait_for_locks(_tell_holder))

    help = "Wait while another process writes the folder."
    kind = Annotated[bool, more_option("--wait", help=help, callback=wait)]

    def declare(wait: kind = False) -> None:  # type: ignore[valid-type]
        """Declare the option."""

    app = typer.Typer(rich_markup_mode=None, add_completion=False)
    app.command()(declare)
    option = typer.main.get_command(app).params[0]
    option.expose_value = False
    return option


def _tell_holder(holder: str) -> None:
    print(f"waiting for {holder} ...", file=sys.stderr, flush=True)


def _module_of(words: list[str]) -> str:
    parts = [f"{word}_" if iskeyword(word) else word.replace("-", "_") for word in words]
    if len(words) == 1 and words[0] in FOLDERS:
        parts.append("command")
    return ".".join(("world2minecraft.cli", *parts))


def _name_values(command: Any, function: Callable[..., Any]) -> None:
    """Set the placeholder of each argument and value, equal in help and errors."""
    declared = signature(function).parameters
    for one in command.params:
        if one.param_type_name == "argument":
            word = (one.metavar or one.name.upper()).removesuffix("...")
            one.metavar = word[1:-1] if word[0] + word[-1] == "[]" else word
        elif one.metavar is None and not one.is_flag and one.name in declared:
            kind = declared[one.name].annotation  # Annotated[...], of which the type is the first.
            kind = str(kind.__origin__ if hasattr(kind, "__metadata__") else kind)
            one.metavar = next((VALUE_WORDS[part] for part in VALUE_WORDS if part in kind), None)


def _family(word: str, prefix: str = "") -> Any:
    """Return the group of the verbs that start with a word, or None if there are none."""
    first = f"{prefix}{word}"
    if not any(verb.startswith(f"{first} ") for verb in VERBS):
        return None
    app = typer.Typer(
        cls=VerbGroup, rich_markup_mode=None, add_completion=False, subcommand_metavar="VERB ..."
    )
    app.callback(help=FAMILIES.get(first, f"Run a verb of {first}."))(_no_options)
    group = typer.main.get_command(app)
    group.name, group.prefix = first, f"{first} "  # type: ignore[attr-defined]
    return group


def _no_options() -> None:
    """Accept no options, because a group of verbs only has a help page."""


def _help(verb: str, function: Callable[..., Any]) -> str:
    """Return the verb's summary and its docstring without the first line and the sections."""
    details = cleandoc(function.__doc__ or "").partition("\n\n")[2]
    for section in ("Args:", "Raises:"):
        details = details.partition(section)[0]
    return f"{VERBS[verb]}\n\n{details.strip()}"


def _app() -> typer.Typer:
    app = typer.Typer(
        cls=VerbGroup, rich_markup_mode=None, add_completion=False, subcommand_metavar="VERB ..."
    )
    app.callback(help="Turn real rooms into Minecraft worlds.")(_global_options)
    return app


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"w2m {__version__}")
        raise typer.Exit()


def _global_options(
    _version: Annotated[
        bool,
        typer.Option(
            "--version", is_eager=True, callback=_show_version, help="Show the version and exit."
        ),
    ] = False,
    _traceback: Annotated[
        bool,
        typer.Option("--traceback", help="Show a traceback on errors; allowed anywhere."),
    ] = False,
) -> None:
    """Accept the options before the verb, which ``_show_version`` and ``cli.run`` process."""


def _write_examples(formatter: Any, examples: str) -> None:
    width = max(formatter.width, get_terminal_size().columns)
    with formatter.section("Examples"):
        for line in examples.strip().splitlines():
            formatter.write(f"{fit_example(f'  {line}', width)}\n")


def fit_example(line: str, width: int) -> str:
    """Move the description of an example to the left, or below it, if the line is too long.

    Example:
        >>> fit_example("w2m scan room.r3d          the export of an app", 40)
        'w2m scan room.r3d   the export of an app'
    """
    excess, parts = len(line) - width, EXAMPLE.fullmatch(line)
    if excess <= 0 or parts is None:
        return line
    command, gap, description = parts.groups()
    if excess <= len(gap) - 2:
        return f"{command}{gap[excess:]}{description}"
    return f"{command}\n      {description}"
