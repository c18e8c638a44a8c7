"""Experiments as dictionaries: what stands for an XML file."""

from xml.sax.saxutils import escape, quoteattr


def text_of(value):
    """A value as experiment files write it: (1, 2, 0) is "1,2,0", True is "true"."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (tuple,)):
        return ",".join(text_of(one) for one in value)
    if isinstance(value, float):
        return repr(value)
    if hasattr(value, "item") and not isinstance(value, (str, bytes)):  # numpy's numbers
        return text_of(value.item())
    return str(value)


def _element(name, content, depth, lines):
    if not isinstance(content, dict):
        raise TypeError(f"<{name}> is to be a dictionary of its attributes and elements, and is a {type(content).__name__}")
    attributes, children = [], []
    for key, value in content.items():
        if not isinstance(key, str):
            raise TypeError(f"<{name}>: names are texts, and {key!r} is none")
        if isinstance(value, dict):
            children.append((key, value))
        elif isinstance(value, list):
            children.extend((key, one) for one in value)
        elif value is not None:
            attributes.append(f" {key}={quoteattr(text_of(value))}")
    indent = "  " * depth
    begin = f"{indent}<{name}{''.join(attributes)}"
    if not children:
        lines.append(begin + "/>")
        return
    lines.append(begin + ">")
    for key, value in children:
        _element(key, value, depth + 1, lines)
    lines.append(f"{indent}</{escape(name)}>")


def to_xml(experiment):
    """The XML of an experiment that is written as a dictionary.

    A dictionary is an element, a list several of one name, all else an attribute; a tuple is "a,b,c".

        {"framework": {"experiment": {"length": 60, "ticks_per_second": 10}},
         "arena": {"size": (4, 4, 1), "distribute": [{...}, {...}]}, ...}
    """
    lines = []
    _element("tandem", experiment, 0, lines)
    return "\n".join(lines) + "\n"


def assignments(parameters):
    """{"controllers.x.params.speed": 3} as ["controllers.x.params.speed=3"]."""
    if parameters is None:
        return []
    if isinstance(parameters, dict):
        return [f"{path}={text_of(value)}" for path, value in parameters.items()]
    if isinstance(parameters, str) or not hasattr(parameters, "__iter__"):
        raise TypeError(f'parameters are {{"path": value}} or ["path=value"], not {parameters!r}')
    return [str(one) for one in parameters]


def source(experiment):
    """(file, text) of what a world may be made of: a path, XML text or a dictionary."""
    if isinstance(experiment, dict):
        return "experiment", to_xml(experiment)
    if isinstance(experiment, str) and experiment.lstrip().startswith("<"):
        return "experiment", experiment
    if isinstance(experiment, bytes) or not hasattr(experiment, "__fspath__") and not isinstance(experiment, str):
        raise TypeError(f"an experiment is a path, XML text or a dictionary, not a {type(experiment).__name__}")
    import os

    return os.fspath(experiment), ""
