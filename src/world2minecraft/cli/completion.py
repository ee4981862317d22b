"""Print a shell completion script: ``w2m completion``.

The script calls ``w2m`` with ``_W2M_COMPLETE`` set, and typer replies with the matching names:
verbs from the table in ``cli.verbs``, and options from the module of the verb.
"""

from typing import Annotated

import typer

from world2minecraft.cli.verbs import COMPLETE_VARIABLE

EXAMPLES = """\
w2m completion bash
w2m completion zsh
w2m completion fish
"""
SHELLS = ("bash", "zsh", "fish")


def run(shell: Annotated[str, typer.Argument(help="bash, zsh or fish.")]) -> None:
    """Print a script that completes verbs and options of w2m.

    bash: add  eval "$(w2m completion bash)"  to ~/.bashrc.

    zsh: add  eval "$(w2m completion zsh)"  to ~/.zshrc, after compinit.

    fish: run  w2m completion fish > ~/.config/fish/completions/w2m.fish  once.

    Args:
        shell: Shell to write the script for.

    Raises:
        UnknownNameError: If the shell is not supported.
    """
    from typer.completion import get_completion_script  # type: ignore[attr-defined]

    from world2minecraft.core.errors import UnknownNameError

    if shell not in SHELLS:
        raise UnknownNameError("shell", shell, SHELLS)
    print(get_completion_script(prog_name="w2m", complete_var=COMPLETE_VARIABLE, shell=shell))
