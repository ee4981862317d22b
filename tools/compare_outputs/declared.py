"""What may differ between the base and the tree: names that were changed, and what varies.

Whoever renames a verb, an option, a file, a key or a sentence declares it here, old to new, in the
same commit. Nothing else may differ.
"""

import re

# How the command line is started: `python -m ...` in each tree.
ENTRY = "world2minecraft.cli"
TREE_ENTRY = ENTRY

# Verbs of the command line, one or two words: "vln reword": "vln words".
VERBS: dict[str, str] = {}
# Options and other words of one verb, by its old name: ("render", "--poses"): "--tour-file".
WORDS: dict[tuple[str, str], str] = {}
# Modules that the table's Python scripts import, and other words of theirs.
MODULES: dict[str, str] = {
    "world2minecraft.coordinates": "world2minecraft.core.coordinates",
    "world2minecraft.exchange.source": "world2minecraft.formats.build_reader",
    "read_source": "read_build",
    "LookLight": "LightSettings",
    "world2minecraft.render": "world2minecraft.rendering",
    "world2minecraft.types": "world2minecraft.core.types",
    "world2minecraft.vln.environment": "world2minecraft.navigation.environment",
}

# Files and folders that the program names: a part of a path, from slash to slash.
FILES: dict[str, str] = {}
# Keys of JSON and YAML, names of arrays in .npz, columns of tables.
KEYS: dict[str, str] = {}
# Pieces of text: in reports, READMEs, instructions, string values, and what commands print.
TEXTS: dict[str, str] = {
    "or all, anew by other figures": "or all, again by other parameters",
    "furniture of objects anew": "furniture of objects again",
    "and matched anew": "and matched again",
}

# Pictures that are drawn in another way now, and looked at by a person: only that they are there.
REDRAWN: tuple[str, ...] = (
    r"(.*/)?PLOTS/(classes|fine_classes|scenes)\.png",  # Drawn by matplotlib now.
    r"(.*/)?lengths\.png",
)


def forget() -> None:
    """Declare nothing: both sides speak alike."""
    for names in (VERBS, WORDS, MODULES, FILES, KEYS, TEXTS):
        names.clear()


# ---- What differs by nature, on one side as on both. Found by running the base twice.

# Text that is replaced before texts are compared: a pattern, and what stands in its place.
VARYING_TEXTS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"\b0\.\d+\.\d+(?:\.dev\d+)?\b(?=\W|$)"), "<version>"),
    (re.compile(r"\b20\d\d-\d\d-\d\d(?:[T ]\d\d:\d\d(?::\d\d)?(?:\.\d+)?Z?)?"), "<date>"),
)
# The same, in what commands print alone: times, rates, memory, and the note of a first run.
VARYING_PRINTS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"(?m)^First run: compiling.*\n"), ""),
    (re.compile(r"\b\d[\d,]*(?:\.\d+)? ?(?:ms|s|seconds?|min|minutes?)\b"), "<time>"),
    (re.compile(r"\b\d[\d,]*(?:\.\d+)? (?:GB|MB|KB)\b"), "<bytes>"),
    (re.compile(r"127\.0\.0\.1:\d+"), "<address>"),
)
# Lines of what commands print that tell of speed alone.
VARYING_LINES = re.compile(
    r"^\s*made   .* images in .*CPU each|Total time|Automated process|Manual refinement"
)

# Keys of JSON whose values differ by nature, by a pattern of the file's path: ".*" stands for all.
VARYING_KEYS: tuple[tuple[str, frozenset[str]], ...] = (
    (r"(.*/)?run\.json", frozenset({"*"})),  # Seconds, memory, the machine: nothing reads it.
    (r"(.*/)?w2m_undo/.*/manifest\.json", frozenset({"time_ns"})),  # Of the world's own files.
    (r"(.*/)?(replies|answers|trace)\.jsonl", frozenset({"latency_s"})),  # A model's.
    (r"(.*/)?effort\.jsonl", frozenset({"time_s"})),  # When a person edited.
    (r"(.*/)?journal\.bin", frozenset({"time_s"})),
    (r"\d+\.stdout", frozenset({"active_s", "manual_s", "total_s"})),  # Of w2m forge stats --json.
    (r".*\.safetensors", frozenset({"seconds", "cpu_seconds"})),  # How long training took.
)
# Files whose content is not compared, only that they are there.
VARYING_FILES: tuple[str, ...] = (
    r"(.*/)?events\.out\.tfevents\..*",  # TensorBoard's; metrics.csv beside it says the same.
)
# Archives whose members are compared, and not when these were written.
VARYING_ARCHIVES: tuple[str, ...] = (r"exported-world-.*\.zip",)
# Names that hold a time, a machine or a number of a process: a pattern, and what stands for it.
VARYING_NAMES: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"events\.out\.tfevents\..*"), "events.out.tfevents.*"),
)
