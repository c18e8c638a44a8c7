"""Errors of calls in people's words: the module's own name types of C++."""

import difflib
import functools
import inspect
import re


def _complaint(label, takes, names, arguments, named):
    unknown = [one for one in named if one not in names]
    given = ", ".join([repr(one) for one in arguments] + [f"{name}={value!r}" for name, value in named.items()])
    words = f"{label} has no argument '{unknown[0]}'" if unknown else f"{label} was called with ({given})"
    words += f"; it takes ({takes or 'nothing'})"
    near = difflib.get_close_matches(unknown[0], names, 1) if unknown else []
    return words + (f". Did you mean '{near[0]}'?" if near else "")


def hinted(method):
    """A method whose complaint about an argument that it does not have names what it has."""
    names = [name for name in inspect.signature(method).parameters if name != "self"]

    @functools.wraps(method)
    def call(self, *arguments, **named):
        if not set(named).issubset(names):
            raise TypeError(_complaint(type(self).__name__, ", ".join(names), names, arguments, named))
        return method(self, *arguments, **named)

    return call


def _plain(label, method):
    @functools.wraps(method)
    def call(self, *arguments, **named):
        try:
            return method(self, *arguments, **named)
        except TypeError as error:
            if f"{method.__name__}(): incompatible function arguments" not in str(error):
                raise
            signature = re.sub(r"\b(tandem\.)?_tandem\.", "", method.__doc__.partition("\n")[0])
            listed = re.split(r", (?=\w+:)", signature[signature.index("(") + 1 : signature.rindex(")")])[1:]
            complaint = _complaint(label, ", ".join(listed), [one.partition(":")[0] for one in listed], arguments, named)
        raise TypeError(complaint)

    return call


def speak_plainly(*classes):
    """Has the methods of classes of pybind11 say what they take when they are called with something else."""
    for cls in classes:
        for name, method in list(vars(cls).items()):
            if not name.startswith("_") and callable(method) and not isinstance(method, (staticmethod, type)):
                setattr(cls, name, _plain(f"{cls.__name__}.{name}", method))
