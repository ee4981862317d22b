"""What registries name as a string is there: a moved module breaks no built-in name."""

from importlib import import_module
from pathlib import Path

import world2minecraft
from world2minecraft.core.registry import Registry
from world2minecraft.sceneforge.document.document_metadata import FORMAT

SOURCE = Path(world2minecraft.__file__).parent


def modules():
    for path in sorted(SOURCE.rglob("*.py")):
        parts = path.relative_to(SOURCE.parent).with_suffix("").parts
        if parts[-1] != "__main__" and "Registry(" in path.read_text():
            yield ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def test_each_built_in_name_of_a_registry_loads():
    values = [value for name in modules() for value in vars(import_module(name)).values()]
    found = [one for one in values if isinstance(one, Registry)]
    assert len(found) >= 15
    for registry in found:
        assert all(registry.load(name) is not None for name in registry._builtins)


def test_documents_of_former_versions_keep_their_format():
    assert FORMAT == "world2minecraft/forge"
