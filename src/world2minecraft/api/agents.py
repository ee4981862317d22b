"""Run navigation agents, evaluate them on a navigation set and compare the results."""

import webbrowser
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.external_models.chat_messages import MAX_PX
from world2minecraft.external_models.model_options import ModelOptions

if TYPE_CHECKING:
    from world2minecraft.external_models.chat_client import ChatModel
    from world2minecraft.navigation.agents.types import Agent, Decision, Observation  # noqa: F401
    from world2minecraft.navigation.running.episode_runner import EpisodeWalk, Observer
    from world2minecraft.navigation.running.item_evaluation import Answerer
    from world2minecraft.navigation.types import Episode, Item, Move, Stance

Table = list[list[str]]


@dataclass(frozen=True, eq=False)
class AgentRun:
    """The walks of an agent, stored in a folder.

    Attributes:
        folder: Folder with ``result.json``, ``episodes.jsonl`` and the trace of each walk.
        result: Contents of ``result.json``: the scores of the agent and those of the Stop, Random
            and oracle agents.
        episodes: Episodes that the agent walked.
        model: Name of the language model. Empty if no model was used.
        cost: Number of requests and tokens and the cost in dollars. Empty if no model was used.
    """

    folder: Path
    result: Mapping[str, Any]
    episodes: Sequence["Episode"]
    model: str = ""
    cost: Mapping[str, Any] = field(default_factory=dict)

    @property
    def summary(self) -> Mapping[str, Any]:
        """The mean scores, such as ``spl`` and ``ne_m``. See docs/reference/vln-scores.md."""
        return self.result["summary"]

    def walk_folder(self, number: int = 0) -> Path:
        """Return the folder with the trace, and the video if any, for one walk."""
        from world2minecraft.navigation.agent_runs import walk_folder

        return walk_folder(self.folder, number, self.episodes)

    def __repr__(self) -> str:
        walks = len(self.episodes)
        return f"AgentRun({str(self.folder)!r}, {self.result['agent']}, {walks} walks)"


def run_agent(
    scene: Run | str | Path,
    instruction: str = "",
    *,
    agent: "str | Agent" = "oracle",
    out: str | Path | None = None,
    goal: str = "",
    start: Sequence[float] | None = None,
    moves: str = "vlnce",
    max_steps: int = 120,
    chunk: int = 4,
    history: int = 3,
    map_kind: str = "none",
    count: int | None = None,
    seed: int = 0,
    video: bool = True,
    server: str = "",
    max_pixels: int = MAX_PX,
    force: bool = False,
    model: ModelOptions | None = None,
    observers: "Sequence[Observer]" = (),
    on_page: Callable[[str], object] = webbrowser.open,
) -> AgentRun:
    """Run an agent on an instruction and score it next to the Stop, Random and oracle agents.

    The goal is the last object named in the instruction. Call the function again to resume an
    interrupted run. Replies from a model are recorded and are not requested twice.

    Args:
        scene: A run, a generated house, a world or a block file. For a navigation set or an
            ``episodes.jsonl`` file, the agent walks all its episodes.
        instruction: Instruction such as "Go to the piano". Leave empty for episodes.
        agent: ``oracle``, ``shortest``, ``random``, ``forward``, ``stop`` or ``human``. For a
            language model, ``gemini``, ``openai``, ``qwen`` or ``local``, optionally followed by
            ``:MODEL``, or a server address ``http://HOST/v1``. Also accepts an object with the
            methods ``begin`` and ``decide``.
        out: Output folder. Defaults to ``vln_AGENT``.
        goal: Name of the goal object, if the instruction does not name it.
        start: Start position of the feet in world blocks, as (x, y, z) or (x, y, z, yaw in
            degrees).
        moves: ``vlnce`` (0.25 m, 15 degrees), ``rxr`` (30 degrees) or ``block``.
        max_steps: Maximum number of moves per walk.
        chunk: Maximum number of moves per reply from a model, from 1 to 4.
        history: Number of earlier views included in each request to a model.
        map_kind: ``none``, ``text`` (earlier positions in words) or ``plan`` (a floor plan).
        count: Number of episodes to walk, from the start of the set. Defaults to all.
        seed: Random seed for agents that act at random.
        video: Whether to write ``walk.mp4`` for each walk.
        server: HOST or HOST:PORT of a game server that contains the scene. The agent then controls
            a player on this server.
        max_pixels: Maximum image size in pixels for a model. Larger images are scaled down.
        force: Write into a folder that contains other files.
        model: Options for the language model.
        observers: Callbacks that are called during each walk. See
            ``navigation.running.episode_runner.Observer``.
        on_page: Callback that receives the URL of the page on which a human controls the walk.

    Raises:
        UsageError: If a name or an option is invalid, or the folder contains other files without
            ``force``.
        ConflictError: If another process writes the folder.
        InputError: If the scene or the goal is not found.
        ServerError: If a model does not reply.
        BudgetError: If a limit on requests or cost is reached.

    Example:
        >>> import world2minecraft as w2m
        >>> walk = w2m.run_agent(run, "Go to the desk", out=tmp / "walk", video=False)
        >>> walk.summary["spl"] > 0.9
        True
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.navigation.agent_runs import AGENT_RUN, RunRequest, check_out, run_walks
    from world2minecraft.navigation.agents import make_agent
    from world2minecraft.navigation.running.sentence_goals import GoalRequest

    name = agent if isinstance(agent, str) else agent.name
    place, folder = path_of(scene), Path(out) if out is not None else default_run_folder(name)
    check_out(folder, place)
    chats: list[ChatModel] = []

    def chat() -> "ChatModel":
        chats.append((model or ModelOptions()).open(name, folder))
        return chats[0]

    def facts() -> dict[str, Any]:
        return {"model": chats[0].name, "cost": chats[0].ledger.to_json()} if chats else {}

    how: dict[str, Any] = {"map_kind": map_kind, "max_px": max_pixels}
    wish = GoalRequest(instruction, goal, _stance(start), moves, max_steps)
    request = RunRequest(place, folder, wish, count, seed, video, server, observers)
    with output_folder(folder, AGENT_RUN, "written", force=force):
        walker = (
            make_agent(agent, chat, chunk=chunk, history=history, **how)
            if isinstance(agent, str)
            else agent
        )
        episodes, result = run_walks(request, walker, on_page, facts)
    return AgentRun(folder, result, episodes, **facts())


@dataclass(frozen=True, eq=False)
class AgentAnswers:
    """Answers from an agent to the items in a navigation set.

    Attributes:
        folder: Folder with ``answers.jsonl`` and ``result.json``.
        result: Contents of ``result.json``. ``result["accuracy"]`` is grouped by task and
            composition.
        count: Number of items.
        cost: Number of requests and tokens and the cost in dollars. Empty if no language model was
            used.
    """

    folder: Path
    result: Mapping[str, Any]
    count: int
    cost: Mapping[str, Any] = field(default_factory=dict)

    @property
    def accuracy(self) -> Mapping[str, Any]:
        """Accuracy by task, then by composition: share, interval, hits, total and chance."""
        return self.result["accuracy"]

    def __repr__(self) -> str:
        return f"AgentAnswers({str(self.folder)!r}, {self.result['agent']}, {self.count:,} items)"


def evaluate_agent(
    navigation_set: str | Path,
    agent: "str | Answerer",
    *,
    out: str | Path | None = None,
    split: str = "test",
    task: str = "both",
    composition: str = "combined",
    count: int | None = None,
    seed: int = 0,
    style: str = "letter",
    training: str = "none",
    jobs: int = 1,
    max_pixels: int = MAX_PX,
    force: bool = False,
    model: ModelOptions | None = None,
    progress: Progress = no_progress,
) -> AgentAnswers:
    """Evaluate an agent on the items in a navigation set and score its answers.

    If a reply contains no letter, the request is repeated up to two times, and the answer then
    counts as wrong. Call the function again to resume an interrupted evaluation.

    Args:
        navigation_set: Folder of a navigation set, or its ``items.jsonl``.
        agent: ``gemini``, ``openai``, ``qwen`` or ``local``, optionally followed by ``:MODEL``, or
            a server address ``http://HOST/v1``. For a baseline, ``uniform``, ``majority``,
            ``blind``, ``repeat``, ``nearest``, ``alike``, ``odd`` or ``oracle``. Also accepts an
            object with ``name`` and ``answer(item)``.
        out: Output folder. Defaults to ``vln_AGENT``.
        split: ``train``, ``val_seen``, ``val_unseen``, ``test`` (both validation splits) or
            ``all``.
        task: ``next_view``, ``next_action`` or ``both``.
        composition: ``base``, ``extend`` or ``combined``.
        count: Number of randomly sampled items. Defaults to all.
        seed: Random seed for sampling the items.
        style: Format of the replies: ``letter``, ``think`` or ``json``.
        training: How the model was trained, for result tables: ``none``, ``sft`` or ``rft``.
        jobs: Number of concurrent requests.
        max_pixels: Maximum image size in pixels for a model. Larger images are scaled down.
        force: Write into a folder that contains other files.
        model: Options for the language model.
        progress: Callback that is called after each answer.

    Raises:
        UsageError: If a name or an option is invalid, or the folder contains other files without
            ``force``.
        ConflictError: If another process writes the folder.
        InputError: If the set cannot be read.
        ServerError: If the model does not reply.
        BudgetError: If a limit on requests or cost is reached.

    Example:
        >>> import world2minecraft as w2m
        >>> made = w2m.build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> w2m.evaluate_agent(tmp / "set", "oracle", out=tmp / "answers", split="all")
        AgentAnswers(..., oracle, ... items)
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.navigation.agent_runs import AGENT_RUN
    from world2minecraft.navigation.records import read_items
    from world2minecraft.navigation.running.item_evaluation import (
        TRAININGS,
        evaluate,
        select_items,
        write_result,
    )

    if training not in TRAININGS:
        raise UnknownNameError("training", training, TRAININGS)
    place = Path(navigation_set)
    every = read_items(place)
    items = select_items(
        every, split=split, task=task, composition=composition, count=count, seed=seed
    )
    name = agent if isinstance(agent, str) else agent.name
    folder = Path(out) if out is not None else default_run_folder(name)
    images = place if place.is_dir() else place.parent
    chat: ChatModel | None = None
    with output_folder(folder, AGENT_RUN, "written", force=force):
        if not isinstance(agent, str):
            answerer = agent
        elif chat := _chat_of(agent, folder, model):
            answerer = _vlm_answerer(chat, images, style, max_pixels)
        else:
            training = "baseline"
            answerer, items = _baseline(agent, every, items, images)
        found = evaluate(items, answerer, jobs=jobs, progress=progress)
        write_result(
            folder,
            found,
            {"agent": answerer.name, "training": training, "style": style, "split": split},
        )
    cost = {} if chat is None else chat.ledger.to_json()
    return AgentAnswers(folder, read_run_result(folder), len(items), cost)


@dataclass(frozen=True)
class RunTables:
    """Results of several runs as tables of text. The first row of each table contains the titles.

    Attributes:
        results: Contents of each ``result.json``.
        walks: Table with one row per agent. Empty if no run contains walks.
        answers: Accuracy table of the paper, with one row per model and training, and one column
            per task and composition. Empty if no run contains answers.
        paired: Pairwise comparison of the answers with McNemar's exact test. Empty if fewer than
            two runs contain answers.
    """

    results: Sequence[Mapping[str, Any]]
    walks: Table
    answers: Table
    paired: Table

    def to_dict(self) -> dict[str, Any]:
        """Return JSON-compatible results, without the data on individual episodes and items."""
        single = ("episodes", "right")
        results = [{k: v for k, v in one.items() if k not in single} for one in self.results]
        heads = [head.replace(" ", "_") for head in self.paired[0]] if self.paired else []
        pairs = [dict(zip(heads, row, strict=True)) for row in self.paired[1:]]
        return {"results": results, "paired": pairs}


def compare_runs(runs: Sequence[str | Path]) -> RunTables:
    """Compare results from ``run_agent`` and ``evaluate_agent`` in tables.

    Args:
        runs: Folders of the runs.

    Raises:
        InputError: If a run has no result.
        DamagedFileError: If a result cannot be read.

    Example:
        >>> from world2minecraft.api.agents import compare_runs, run_agent
        >>> walk = run_agent(run, "Go to the desk", out=tmp / "walk", video=False)
        >>> [row[0] for row in compare_runs([tmp / "walk"]).walks]
        ['agent', 'oracle', 'stop', 'random']
    """
    from world2minecraft.navigation.running.result_tables import (
        answers_table,
        paired_table,
        walks_table,
    )

    results = [read_run_result(path) for path in runs]
    walks = [one for one in results if one["kind"] == "walks"]
    answers = [one for one in results if one["kind"] == "answers"]
    return RunTables(
        results,
        walks_table(walks) if walks else [],
        answers_table(answers) if answers else [],
        paired_table(answers) if len(answers) > 1 else [],
    )


def read_run_result(path: str | Path) -> dict[str, Any]:
    """Return the contents of a run's ``result.json``.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file cannot be read.
    """
    from world2minecraft.navigation.running.result_tables import read_result

    return read_result(path)


def table_text(table: Table, *, markdown: bool = False) -> str:
    """Format a table as aligned text or as Markdown.

    Example:
        >>> from world2minecraft.api.agents import table_text
        >>> print(table_text([["agent", "SPL"], ["oracle", "1.00"]]))
        agent    SPL
        oracle  1.00
    """
    from world2minecraft.navigation.running.result_tables import format_markdown, format_text

    return (format_markdown if markdown else format_text)(table)


def walks_note() -> str:
    """Return an explanation of the column titles in the table of walks."""
    from world2minecraft.navigation.running.result_tables import HEADS_NOTE

    return HEADS_NOTE


def decision_text(decision: "Decision", made: "Sequence[tuple[Move, bool]]") -> str:
    """Return a short description of the moves that resulted from an agent's decision."""
    from world2minecraft.navigation.running.trace import decision_text as text

    return text(decision, made)


def walk_end_text(walk: "EpisodeWalk") -> str:
    """Return a one-line description of how a walk ended."""
    from world2minecraft.navigation.running.film import end_text

    return end_text(walk)


@dataclass(frozen=True)
class ServerCheck:
    """Result of a test connection to a game server.

    Attributes:
        version: Game version.
        name: Name of the player.
        position: Position of the player in blocks.
        blocks: Number of non-air blocks in the 16x16x16 region around the player.
        states: Number of distinct block states in this region.
    """

    version: str
    name: str
    position: tuple[float, float, float]
    blocks: int
    states: int


def check_server(address: str, *, name: str = "w2m_walker", version: str = "") -> ServerCheck:
    """Join a game server, read the blocks around the player and disconnect.

    Args:
        address: HOST or HOST:PORT of a server with ``online-mode=false``.
        name: Name of the player.
        version: Game version. Defaults to the version that the server reports.

    Raises:
        UsageError: If mineflayer is not installed or the name is invalid.
        ServerError: If the server refuses the connection.
    """
    from world2minecraft.navigation.server.player import join

    with join(address, name=name, version=version) as body:
        x, y, z = body.body.position
        low = [int(value) - 8 for value in (x, y, z)]
        volume = body.read([*low, *(value + 16 for value in low)])
        blocks = int((volume.states > 0).sum())
        return ServerCheck(body.version, body.name, (x, y, z), blocks, len(volume.palette) - 1)


def mineflayer_folder(*, install: bool = False) -> Path:
    """Return the folder of mineflayer, the game server client, and optionally install it first.

    Args:
        install: Download the pinned versions with npm. Install scripts are not executed.

    Raises:
        UsageError: If Node or npm is missing, or mineflayer is not installed.
        ServerError: If npm fails.
    """
    from world2minecraft.navigation.server import mineflayer_install as installing

    return installing.install() if install else installing.body_folder()


def default_run_folder(agent: str) -> Path:
    """Return the default output folder for an agent.

    Example:
        >>> from world2minecraft.api.agents import default_run_folder
        >>> default_run_folder("openai:gpt-4.1").name
        'vln_openai_gpt_4_1'
    """
    return Path(f"vln_{''.join(c if c.isalnum() else '_' for c in agent)[:40]}")


def _stance(start: Sequence[float] | None) -> "Stance | None":
    from math import isfinite

    from world2minecraft.navigation.types import Stance

    if start is None:
        return None
    if len(start) not in (3, 4) or not all(isfinite(one) for one in start):
        raise UsageError(
            f"start must be X,Y,Z or X,Y,Z,YAW, got {','.join(f'{one:g}' for one in start)!r}"
        )
    return Stance(*start)


def _chat_of(agent: str, folder: Path, model: ModelOptions | None) -> "ChatModel | None":
    """Return the language model for an agent's name or address, or None for other agents."""
    from world2minecraft.external_models.chat_transport import is_endpoint

    return (model or ModelOptions()).open(agent, folder) if is_endpoint(agent) else None


def _vlm_answerer(chat: "ChatModel", images: Path, style: str, max_pixels: int) -> "Answerer":
    from world2minecraft.navigation.agents.question_answering import VlmAnswerer

    return VlmAnswerer(chat, images, style, max_px=max_pixels)


def _baseline(
    name: str, every: "list[Item]", items: "list[Item]", images: Path
) -> "tuple[Answerer, list[Item]]":
    """Return a baseline and the items that it can answer."""
    from world2minecraft.external_models.chat_transport import ENDPOINTS
    from world2minecraft.navigation.agents.question_answering import LetterAnswerer
    from world2minecraft.navigation.data.blind_baselines import BASELINES, baseline_letters

    if name not in BASELINES:
        raise UnknownNameError("agent", name, [*BASELINES, *ENDPOINTS])
    letters = baseline_letters(name, every, items, images)
    known = [item for item in items if item.item_id in letters]
    if not known:
        raise UsageError(
            f"the baseline {name} cannot answer this task; set the task to both (--task both)"
        )
    return LetterAnswerer(name, letters), known
