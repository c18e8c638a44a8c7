"""Writes the type stubs of the package: `python -m tandem.stubs FOLDER`. Ports come from their schemas."""

import inspect
import os
import re
import sys

from . import _tandem, env, policy, record, rollout, world

_HEAD = '''"""Type stubs of tandem. Made by tandem.stubs of the ports' schemas; not to be edited."""

import os
import subprocess
from typing import Any, Callable, Generic, Iterable, Literal, Mapping, Optional, Sequence, TypeVar, Union, overload

import numpy as np
import numpy.typing as npt

__version__: str

class ExperimentError(ValueError): ...
class RunFailed(RuntimeError): ...

_Number = TypeVar("_Number", bound=np.generic)

class _Array(Generic[_Number]):
    def __get__(self, port: object, owner: Any = ...) -> npt.NDArray[_Number]: ...
    def __set__(self, port: object, value: npt.ArrayLike) -> None: ...

'''

_ENV_HEAD = '''"""Type stubs of tandem.env. Made by tandem.stubs; not to be edited."""

from typing import Any, Callable, Iterable, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import Layer, Swarm, World

'''


def class_name(port):
    """"range_and_bearing", "sensor": RangeAndBearingReadings."""
    stem = "".join(part.capitalize() for part in port["name"].split("_"))
    return stem + ("Readings" if port["role"] == "sensor" else "Commands")


def _meaning(field):
    unit = f", {field['unit']}" if field["unit"] else ""
    shape = f" ({field['count']} elements)" if field["count"] > 1 else ""
    used = f"; '{field['used_by']}' tells how many are in use" if field["used_by"] else ""
    return f"{field['doc']}{unit}{shape}{used}"


def _port_classes(lines):
    ports = _tandem.ports()
    for port in ports:
        for one, suffix in ((True, "Of1"), (False, "")):
            lines.append(f"class {class_name(port)}{suffix}({'Port' if one else 'PortArrays'}):")
            lines.append(f'    """{port["doc"]}"""')
            for field in port["fields"]:
                array = f"_Array[np.{'bool_' if field['type'] == 'bool' else field['type']}]"
                scalar = {"bool": "bool", "f": "float"}.get(field["type"], "float" if field["type"].startswith("f") else "int")
                kind = scalar if one and field["count"] == 1 else array
                lines.append(f"    {field['name']}: {kind}")
                lines.append(f'    """{_meaning(field)}"""')
            lines.append("")
    return ports


def _annotated(text):
    """A signature of pybind11's as a stub's."""
    text = re.sub(r"tandem\._tandem\.|_tandem\.", "", text)
    text = re.sub(r"\(self: \w+", "(self", text)
    text = re.sub(r"List\[", "list[", text)
    text = re.sub(r"Tuple\[", "tuple[", text)
    text = re.sub(r"<[^>]*>", "Any", text)
    text = text.replace("numpy.ndarray[numpy.float64]", "npt.NDArray[np.float64]")
    text = re.sub(r"numpy\.ndarray(\[[^\]]*\])?", "npt.NDArray[Any]", text)
    return re.sub(r"(: |-> )(handle|object|capsule)\b", r"\1Any", text)


def _method(lines, name, function):
    doc = (function.__doc__ or "").strip()
    signature, _, rest = doc.partition("\n")
    if not signature.startswith(name + "("):
        return
    lines.append(f"    def {_annotated(signature)}:")
    rest = rest.strip()
    lines.append(f'        """{rest}"""' if rest else "        ...")


def _getter_type(member):
    doc = (member.fget.__doc__ or "").strip().partition("\n")[0]
    found = re.search(r"-> (.*)$", doc)
    return _annotated(found.group(1)) if found else "Any"


_PROPERTY_TYPES = {
    "World": {"swarms": "list[Swarm]", "poses": "npt.NDArray[np.float64]"},
    "Swarm": {"poses": "npt.NDArray[np.float64]", "alive": "npt.NDArray[np.bool_]",
              "ids": "list[str]", "sensors": "list[str]", "actuators": "list[str]", "published_names": "list[str]"},
}


def _members(lines, cls, ports):
    known = _PROPERTY_TYPES.get(cls.__name__, {})
    for name, member in vars(cls).items():
        if name in ("sensor", "actuator") and cls.__name__ in ("Swarm", "Robot"):
            role, suffix = name, "" if cls.__name__ == "Swarm" else "Of1"
            for port in ports:
                if port["role"] == role:
                    lines.append("    @overload")
                    lines.append(f"    def {name}(self, name: Literal[{port['name']!r}]) -> {class_name(port)}{suffix}: ...")
            lines.append("    @overload")
            lines.append(f"    def {name}(self, name: str) -> {'PortArrays' if not suffix else 'Port'}: ...")
        elif isinstance(member, property):
            lines.append("    @property")
            lines.append(f"    def {name}(self) -> {known.get(name) or _getter_type(member)}:")
            lines.append(f'        """{(member.__doc__ or "").strip()}"""')
        elif not name.startswith("_") and callable(member):
            _method(lines, name, member)


_RETURNS = {"__enter__": "World", "__init__": "None", "__len__": "int", "view": "subprocess.Popen[Any]", "reset": "None",
            "evaluate": "npt.NDArray[np.float64]", "array": "npt.NDArray[np.float64]", "save": "None"}


_ENV_RETURNS = {
    "VectorEnv": {
        "__init__": "None", "close": "None", "save_policy": "None", "render": "tuple[Any, ...]",
        "reset": "tuple[npt.NDArray[np.float32], dict[str, Any]]",
        "step": "tuple[npt.NDArray[np.float32], npt.NDArray[np.float64], npt.NDArray[np.bool_], npt.NDArray[np.bool_], dict[str, Any]]"},
    "ParallelEnv": {
        "__init__": "None", "close": "None", "save_policy": "None", "render": "Any", "state": "npt.NDArray[np.float32]",
        "reset": "tuple[dict[str, npt.NDArray[np.float32]], dict[str, dict[str, Any]]]",
        "step": "tuple[dict[str, npt.NDArray[np.float32]], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]"},
}
_PYTHON_PROPERTIES = {"swarm": "Swarm", "parameters": "npt.NDArray[np.float64]", "world": "World", "worlds": "list[World]",
                      "num_agents": "int", "max_num_agents": "int"}


def _python_class(lines, cls, base="", returns=_RETURNS):
    lines.append(f"class {cls.__name__}{base}:")
    lines.append(f'    """{inspect.getdoc(cls) or ""}"""')
    for name, member in vars(cls).items():
        if isinstance(member, property):
            lines += ["    @property", f"    def {name}(self) -> {_PYTHON_PROPERTIES.get(name, 'Any')}:",
                      f'        """{inspect.getdoc(member) or ""}"""']
            if member.fset is not None:
                lines += [f"    @{name}.setter", f"    def {name}(self, value: npt.ArrayLike) -> None: ..."]
        elif inspect.isfunction(member) and (not name.startswith("_") or name in ("__init__", "__len__", "__call__", "__getitem__", "__enter__", "__exit__")):
            text = str(inspect.signature(member))
            text = re.sub(r"<[^>]*>", "...", text)
            text = re.sub(r"\binf\b", "...", text)
            lines.append(f"    def {name}{text}{' -> ' + returns[name] if name in returns else ''}:")
            lines.append(f'        """{inspect.getdoc(member) or ""}"""')
    lines.append("")


def write(folder):
    lines = [_HEAD]
    for name in ("Port", "PortArrays", "Snapshot", "Picture", "Random"):
        cls = getattr(_tandem, name)
        lines.append(f"class {name}:")
        lines.append(f'    """{(cls.__doc__ or "").strip()}"""')
        if name in ("Port", "PortArrays"):
            lines.append("    def __getattr__(self, name: str) -> Any: ...")
            lines.append("    def __setattr__(self, name: str, value: Any) -> None: ...")
        _members(lines, cls, [])
        lines.append("")
    ports = _port_classes(lines)
    for name in ("Swarm", "Robot"):
        cls = getattr(_tandem, name)
        lines.append(f"class {name}:")
        lines.append(f'    """{(cls.__doc__ or "").strip()}"""')
        if name == "Swarm":
            lines.append("    def __len__(self) -> int: ...")
        _members(lines, cls, ports)
        lines.append("")
    lines.append("class _World:")
    _members(lines, _tandem.World, [])
    lines.append("")
    _python_class(lines, world.World, "(_World)")
    lines.append("class _Group:")
    _members(lines, _tandem.Group, [])
    lines.append("")
    _python_class(lines, world.Group, "(_Group)")
    for cls in (policy.Signal, policy.Layer):
        lines.append(f"class {cls.__name__}:")
        lines.append(f'    """{inspect.getdoc(cls)}"""')
        for field in cls.__dataclass_fields__.values():
            kind = "npt.NDArray[np.float64]" if "ndarray" in str(field.type) else getattr(field.type, "__name__", "Any")
            lines.append(f"    {field.name}: {kind}")
        arguments = ", ".join(name + ("" if field.default.__class__.__name__ == "_MISSING_TYPE" else "=...")
                              for name, field in cls.__dataclass_fields__.items())
        lines.append(f"    def __init__(self, {arguments}) -> None: ...")
        lines.append("")
    _python_class(lines, policy.Policy)
    for cls in (rollout.Rollout,):
        lines.append(f"class {cls.__name__}:")
        lines.append(f'    """{inspect.getdoc(cls)}"""')
        lines += [f"    {name}: Any" for name in cls.__dataclass_fields__]
        lines.append("")
    _python_class(lines, rollout.Rollouts, "(Sequence[Rollout])")
    table = "dict[str, npt.NDArray[Any]]"
    _python_class(lines, record.Record, returns={"__init__": "None", "table": table, "__getitem__": table, "picture": "Picture"})
    lines[-1:] = [f"    {one}" for one in ("path: str", "tables: list[str]", "damage: list[str]", "cut: bool", "start: dict[str, Any]",
                                           "events: list[tuple[int, dict[str, Any]]]")] + [""]
    import tandem

    returns = {"rollouts": "Rollouts", "save_policy": "None", "load_policy": "Policy", "to_xml": "str", "ports": "list[dict[str, Any]]"}
    for function in (rollout.rollouts, policy.save_policy, policy.load_policy, tandem.to_xml, tandem.ports):
        lines.append(f"def {function.__name__}{inspect.signature(function)} -> {returns[function.__name__]}:")
        lines.append(f'    """{inspect.getdoc(function)}"""')
    _save(folder, "__init__.pyi", lines)

    lines = [_ENV_HEAD]
    for cls, attributes in ((env.VectorEnv, ("num_envs: int", "robots: int", "closed: bool", "metadata: dict[str, Any]",
                                             "observation_space: Any", "action_space: Any", "single_observation_space: Any",
                                             "single_action_space: Any")),
                            (env.ParallelEnv, ("metadata: dict[str, Any]", "agents: list[str]", "possible_agents: list[str]",
                                               "observation_spaces: dict[str, Any]", "action_spaces: dict[str, Any]"))):
        _python_class(lines, cls, returns=_ENV_RETURNS[cls.__name__])
        lines[-1:] = [f"    {one}" for one in attributes] + [""]
    _save(folder, "env.pyi", lines)


def _save(folder, name, lines):
    text = "\n".join(lines) + "\n"
    text = re.sub(r'(\n +)"""(""")', r'\1...', text)  # no documentation
    compile(text, name, "exec")
    with open(os.path.join(folder, name), "w") as file:
        file.write(text)


if __name__ == "__main__":
    write(sys.argv[1])
