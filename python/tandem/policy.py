"""Policies: small networks that read some fields of ports and write others.

A policy that was trained here runs on robots as the controller `neural`:

    tandem.save_policy("policy.json", inputs, outputs, layers)

    <neural id="n"><sensors>…</sensors><actuators>…</actuators><params policy="policy.json"/></neural>
"""

import dataclasses
import functools
import json
import math
import os

import numpy as np

_ACTIVATIONS = {
    "identity": lambda x: x,
    "relu": lambda x: np.maximum(x, 0.0),
    "tanh": np.tanh,
    "sigmoid": lambda x: 1.0 / (1.0 + np.exp(-x)),
}


@dataclasses.dataclass
class Signal:
    """Elements of a field of a port, and what becomes of them.

    Of an input: scale * clip(value, low, high) + offset; what is not in use, no number, or was never measured counts as
    0. Of an output: clip(scale * value + offset, low, high).
    """

    port: str
    field: str
    count: int = 1
    first: int = 0
    low: float = -math.inf
    high: float = math.inf
    scale: float = 1.0
    offset: float = 0.0

    @classmethod
    def of(cls, described):
        """A signal of what people write: a Signal, "port.field", (port, field, {…}) or a dictionary."""
        if isinstance(described, cls):
            return described
        if isinstance(described, str):
            port, _, field = described.partition(".")
            return cls(port, field)
        if isinstance(described, dict):
            return cls(**{k: v for k, v in described.items() if v is not None})
        port, field, *more = described
        return cls(port, field, **(more[0] if more else {}))


@dataclasses.dataclass
class Layer:
    """activation(weights @ values + bias); weights has a row for each value that comes out."""

    weights: np.ndarray
    bias: np.ndarray
    activation: str = "tanh"


def _elements(role, array, signal):
    """The signal's elements in a field's array over robots: (robots, up to count), a view.

    Fewer than count where the robot's device is shorter than the port."""
    if array.ndim == 1:
        array = array[:, None]
    most = max(_described(role, signal)["count"], array.shape[1])
    if signal.first < 0 or signal.count < 1 or signal.first + signal.count > most:
        raise ValueError(f"'{signal.port}.{signal.field}' has {array.shape[1]} elements, and the signal wants "
                         f"{signal.first} to {signal.first + signal.count - 1}")
    return array[:, signal.first : signal.first + signal.count]


class Inputs:
    """Reads signals of a swarm's sensors as one array (robots, values)."""

    def __init__(self, signals):
        self.signals = [Signal.of(one) for one in signals]
        self.size = sum(one.count for one in self.signals)

    def read(self, swarm, out=None):
        if out is None:
            out = np.empty((len(swarm), self.size))
        at = 0
        for signal in self.signals:
            port = swarm.sensor(signal.port)
            block = out[:, at : at + signal.count]
            at += signal.count
            raw = _elements("sensor", port[signal.field], signal)
            block[:, raw.shape[1] :] = 0.0
            block = block[:, : raw.shape[1]]
            np.clip(raw, signal.low, signal.high, out=block, casting="unsafe")
            if signal.scale != 1.0:
                block *= signal.scale
            if signal.offset != 0.0:
                block += signal.offset
            field = _described("sensor", signal)
            there = port["validity"] != 0
            if field["used_by"]:
                entries = port[field["used_by"]].astype(np.int64) * field["per_entry"]
                numbers = np.arange(signal.first, signal.first + raw.shape[1])
                block[~(there[:, None] & (numbers[None, :] < entries[:, None]))] = 0.0
            elif not there.all():
                block[~there] = 0.0
            bad = np.isnan(block)
            if bad.any():
                block[bad] = 0.0
        return out


class Outputs:
    """Writes one array (robots, values) into signals of a swarm's actuators."""

    def __init__(self, signals):
        self.signals = [Signal.of(one) for one in signals]
        self.size = sum(one.count for one in self.signals)

    def write(self, swarm, values):
        values = np.asarray(values, dtype=float)
        if values.shape != (len(swarm), self.size):
            raise ValueError(f"{len(swarm)} robots take {self.size} values each: an array of shape {(len(swarm), self.size)}, "
                             f"not {values.shape}")
        at = 0
        for signal in self.signals:
            to = _elements("actuator", swarm.actuator(signal.port)[signal.field], signal)
            wanted = signal.scale * values[:, at : at + to.shape[1]] + signal.offset
            wanted = np.clip(wanted, signal.low, signal.high)
            if to.dtype == bool:
                wanted = wanted > 0.5
            elif to.dtype.kind in "iu":
                limits = np.iinfo(to.dtype)
                wanted = np.clip(np.floor(np.nan_to_num(wanted) + 0.5), limits.min, limits.max)
            to[:] = wanted
            at += signal.count


@functools.cache
def _port_fields():
    """(role, port, field): what the field's schema says."""
    from . import _tandem

    return {(port["role"], port["name"], field["name"]): field for port in _tandem.ports() for field in port["fields"]}


def _described(role, signal):
    """What the schema says of a signal's field; of one from a plug-in, that it is as long as its array."""
    return _port_fields().get((role, signal.port, signal.field), {"count": 0, "used_by": ""})


class Policy:
    """A network with what it reads and writes. Called with a swarm it drives all its robots: tandem.World(policies=…)."""

    def __init__(self, inputs, outputs, layers):
        self.inputs, self.outputs = Inputs(inputs), Outputs(outputs)
        self.layers = [one if isinstance(one, Layer) else Layer(*one) for one in layers]
        size = self.inputs.size
        if not self.layers:
            raise ValueError("a policy has at least one layer")
        for number, layer in enumerate(self.layers):
            layer.weights = np.atleast_2d(np.asarray(layer.weights, dtype=float))
            layer.bias = np.asarray(layer.bias, dtype=float).reshape(-1)
            if layer.weights.ndim != 2 or layer.weights.shape[1] != size:
                raise ValueError(f"layer {number} takes {layer.weights.shape[-1]} values, but {size} come in")
            size = layer.weights.shape[0]
            if layer.bias.shape != (size,):
                raise ValueError(f"layer {number} has {layer.bias.size} biases for {size} values")
            if layer.activation not in _ACTIVATIONS:
                raise ValueError(f"there is no activation '{layer.activation}'; there are {', '.join(_ACTIVATIONS)}")
            if not (np.isfinite(layer.weights).all() and np.isfinite(layer.bias).all()):
                raise ValueError(f"layer {number} has numbers that are not finite")
        if size != self.outputs.size:
            raise ValueError(f"the last layer has {size} values for {self.outputs.size} outputs")

    @property
    def parameters(self):
        """All weights and biases as one vector: for evolution and its kin."""
        return np.concatenate([np.concatenate([one.weights.ravel(), one.bias]) for one in self.layers])

    @parameters.setter
    def parameters(self, vector):
        vector = np.asarray(vector, dtype=float).reshape(-1)
        wanted = sum(one.weights.size + one.bias.size for one in self.layers)
        if vector.size != wanted:
            raise ValueError(f"this policy has {wanted} parameters, not {vector.size}")
        at = 0
        for one in self.layers:
            one.weights = vector[at : at + one.weights.size].reshape(one.weights.shape).copy()
            at += one.weights.size
            one.bias = vector[at : at + one.bias.size].copy()
            at += one.bias.size

    def evaluate(self, values):
        """The network alone: (robots, inputs) to (robots, outputs). The controller `neural` may differ in the last bit."""
        for one in self.layers:
            values = _ACTIVATIONS[one.activation](values @ one.weights.T + one.bias)
        return values

    def __call__(self, swarm):
        self.outputs.write(swarm, self.evaluate(self.inputs.read(swarm)))

    def save(self, path):
        """Writes the file that the controller `neural` reads."""

        def described(signal):
            made = {"port": signal.port, "field": signal.field, "first": signal.first, "count": signal.count}
            for name in ("low", "high"):
                if math.isfinite(getattr(signal, name)):
                    made[name] = float(getattr(signal, name))
            made["scale"], made["offset"] = float(signal.scale), float(signal.offset)
            return made

        text = json.dumps({
            "tandem_policy": 1,
            "inputs": [described(one) for one in self.inputs.signals],
            "outputs": [described(one) for one in self.outputs.signals],
            "layers": [{"weights": one.weights.tolist(), "bias": one.bias.tolist(), "activation": one.activation}
                       for one in self.layers],
        }, indent=1, allow_nan=False)
        part = f"{os.fspath(path)}.part"
        with open(part, "w") as file:
            file.write(text + "\n")
        os.replace(part, path)


def save_policy(path, inputs, outputs, layers):
    """Writes a policy for the controller `neural`. layers: Layer, or (weights, bias, activation)."""
    Policy(inputs, outputs, layers).save(path)


def load_policy(path):
    """The policy of a file."""
    with open(path) as file:
        try:
            read = json.load(file)
        except ValueError as error:
            raise ValueError(f"'{path}' is no policy: {error}") from None
    if not isinstance(read, dict) or read.get("tandem_policy") != 1:
        raise ValueError(f"'{path}' is no policy of this version: its member 'tandem_policy' is not 1")
    try:
        return Policy(read["inputs"], read["outputs"], [Layer(**one) for one in read["layers"]])
    except KeyError as error:
        raise ValueError(f"the policy '{path}' has no member {error}") from None
    except (TypeError, ValueError) as error:
        raise ValueError(f"the policy '{path}': {error}") from None
