"""Evolves a network that drives e-pucks fast, straight and clear of walls and one another.

    ./tandem python examples/python/evolve.py --generations 30 --policy policy.json
    ./tandem view configs/epuck_neural.xml --set "controllers.neural[avoid].params.policy=$PWD/policy.json"

The network looks at the eight proximity sensors and sets both wheels. Fitness is that of Floreano and Mondada (1994), a mean
over robots and time: V * (1 - sqrt(dv)) * (1 - i), with V the mean speed of both wheels, dv their difference, and i the
closest reading, each from 0 to 1. The evolution is CMA-ES (Hansen, "The CMA Evolution Strategy: A Tutorial", 2016).
"""

import argparse
import pathlib

import numpy as np

import tandem

EXPERIMENT = pathlib.Path(__file__).resolve().parents[2] / "configs" / "epuck_obstacle_avoidance.xml"
FASTEST = 0.1  # m/s
OBSERVE = [("proximity", "distance", {"count": 8, "high": 0.1, "scale": -10.0, "offset": 1.0})]  # 1 at contact, 0 at 10 cm
ACT = [("differential_steering", side, {"scale": FASTEST}) for side in ("left", "right")]


class CmaEs:
    """Maximises a function of a vector: ask for candidates, tell their fitness."""

    def __init__(self, start, step, population, seed):
        n = self.n = len(start)
        self.mean, self.step, self.random = np.array(start, dtype=float), step, np.random.default_rng(seed)
        self.population = population or 4 + int(3 * np.log(n))
        chosen = self.population // 2
        weights = np.log(chosen + 0.5) - np.log(np.arange(1, chosen + 1))
        self.weights = weights / weights.sum()
        self.mass = mass = 1 / (self.weights**2).sum()  # of the selection
        self.c_step = (mass + 2) / (n + mass + 5)
        self.damping = 1 + 2 * max(0.0, np.sqrt((mass - 1) / (n + 1)) - 1) + self.c_step
        self.c_path = (4 + mass / n) / (n + 4 + 2 * mass / n)
        self.c_one = 2 / ((n + 1.3) ** 2 + mass)
        self.c_rank = min(1 - self.c_one, 2 * (mass - 2 + 1 / mass) / ((n + 2) ** 2 + mass))
        self.normal_length = np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
        self.step_path, self.path, self.covariance, self.generation = np.zeros(n), np.zeros(n), np.eye(n), 0

    def ask(self):
        values, self.axes = np.linalg.eigh(self.covariance)
        self.lengths = np.sqrt(np.maximum(values, 1e-20))
        drawn = self.random.standard_normal((self.population, self.n))
        return self.mean + self.step * (drawn * self.lengths) @ self.axes.T

    def tell(self, candidates, fitness):
        best = candidates[np.argsort(-np.asarray(fitness))[: len(self.weights)]]
        moves = (best - self.mean) / self.step
        move = self.weights @ moves
        self.mean = self.mean + self.step * move
        self.generation += 1
        whitened = self.axes @ ((self.axes.T @ move) / self.lengths)
        self.step_path += -self.c_step * self.step_path + np.sqrt(self.c_step * (2 - self.c_step) * self.mass) * whitened
        length = np.linalg.norm(self.step_path) / np.sqrt(1 - (1 - self.c_step) ** (2 * self.generation))
        grows = length < (1.4 + 2 / (self.n + 1)) * self.normal_length
        self.path += -self.c_path * self.path + grows * np.sqrt(self.c_path * (2 - self.c_path) * self.mass) * move
        one = np.outer(self.path, self.path) + (not grows) * self.c_path * (2 - self.c_path) * self.covariance
        rank = (moves * self.weights[:, None]).T @ moves
        self.covariance += self.c_one * (one - self.covariance) + self.c_rank * (rank - self.covariance)
        self.step *= np.exp(self.c_step / self.damping * (np.linalg.norm(self.step_path) / self.normal_length - 1))


class Score:
    """A hook that measures the fitness."""

    def __init__(self):
        self.sum, self.ticks = 0.0, 0

    def after_step(self, world):
        wheels, proximity = world.swarm.actuator("differential_steering"), world.swarm.sensor("proximity")
        left, right = wheels.left / FASTEST, wheels.right / FASTEST
        closest = 1 - np.clip(proximity.distance.min(axis=1) / 0.1, 0, 1)
        speed = np.clip((left + right) / 2, 0, 1)
        self.sum += (speed * (1 - np.sqrt(np.clip(abs(left - right) / 2, 0, 1))) * (1 - closest)).mean()
        self.ticks += 1
        world.set_measure("fitness", self.sum / self.ticks)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--generations", type=int, default=30)
    parser.add_argument("--population", type=int, help="candidates a generation; default: what CMA-ES takes for so many weights")
    parser.add_argument("--seconds", type=float, default=30, help="of each run")
    parser.add_argument("--seeds", type=int, default=3, help="runs of each candidate")
    parser.add_argument("--seed", type=int, default=1, help="of the evolution")
    parser.add_argument("--policy", default="policy.json", help="the file for the best network")
    options = parser.parse_args()

    policy = tandem.Policy(OBSERVE, ACT, [tandem.Layer(np.zeros((2, 8)), np.zeros(2), "tanh")])

    def use(world, weights):
        policy.parameters = weights

    search = CmaEs(policy.parameters, 0.5, options.population, options.seed)
    for generation in range(options.generations):
        candidates = search.ask()
        runs = tandem.rollouts(EXPERIMENT, list(candidates), seeds=range(1, options.seeds + 1), until=options.seconds, setup=use,
                               policies={"avoid": policy}, hooks=[Score])
        if runs.failed:
            raise SystemExit(f"a run failed: {runs.failed[0].failure}")
        fitness = runs.array("fitness").mean(axis=1)
        search.tell(candidates, fitness)
        print(f"generation {generation + 1}: best {fitness.max():.3f}, mean {fitness.mean():.3f}", flush=True)
    policy.parameters = search.mean
    policy.save(options.policy)
    print(f"the mean of the last generation is in {options.policy}; the controller 'neural' runs it")


if __name__ == "__main__":
    main()
