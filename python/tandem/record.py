"""Records of runs: their tables as arrays, their moments as pictures."""

import json
import os

from . import _tandem


class Record:
    """What a run wrote down with --record, or a world with record=; that of a run that was killed is FILE.part.

    record["pose"] is the table of poses: {"tick", "time" (s, of the tick's end), "ids", and an array for each field}, of
    ticks × ids, or ticks × ids × values; NaN where there is no value.
    """

    def __init__(self, path):
        self.path = os.fspath(path)
        start, self.tables, events, self.damage, self.cut = _tandem._record_contents(self.path)
        self.start = json.loads(start)
        self.events = [(tick, json.loads(event)) for tick, event in events]

    @property
    def name(self):
        return self.start.get("experiment", "")

    @property
    def seed(self):
        return self.start.get("seed")

    @property
    def ticks_per_second(self):
        return self.start.get("ticks_per_second", 10)

    @property
    def settings(self):
        """The experiment as XML, with every default written out."""
        return self.start.get("settings", "")

    def table(self, name, fields=(), entities=(), first=None, last=None, every=1):
        """One table. fields and entities: only these; in ids "*" stands for any text. first, last: ticks, both included."""
        found = _tandem._record_tables(self.path, name, list(fields), list(entities), first, last, every)
        return {path.rsplit("/", 1)[1]: values for path, values in found.items() if not path.startswith("events/")}

    def __getitem__(self, name):
        return self.table(name)

    def __iter__(self):
        return iter(self.tables)

    def picture(self, time=None, size=600, ids=False, axes=False):
        """The run from above at that time in s, or at its end, as notebooks show it."""
        return _tandem._record_picture(self.path, time, size, ids, axes)

    def __repr__(self):
        return f"<tandem.Record '{self.name}', seed {self.seed}: {', '.join(self.tables)}>"
