"""Learns by policy gradient (REINFORCE, Williams 1992) to drive e-pucks fast and clear of walls and one another.

    ./tandem python examples/python/policy_gradient.py --updates 60 --policy policy.json
    ./tandem view configs/epuck_neural.xml --set "controllers.neural[avoid].params.policy=$PWD/policy.json"

All robots of all worlds share one network, which looks at the eight proximity sensors and sets both wheels; while it learns,
commands are drawn from normal distributions around what it says. In each world the reward of a step is a mean over its
robots: the mean speed of both wheels, less what turning and closeness to something cost.
"""

import argparse
import pathlib

import numpy as np

import tandem
from tandem import env

EXPERIMENT = pathlib.Path(__file__).resolve().parents[2] / "configs" / "epuck_obstacle_avoidance.xml"
FASTEST = 0.1  # m/s
OBSERVE = [("proximity", "distance", {"count": 8, "high": 0.1, "scale": -10.0, "offset": 1.0})]  # 1 at contact, 0 at 10 cm
ACT = [("differential_steering", side, {"scale": FASTEST}) for side in ("left", "right")]


def reward(world, swarm):
    wheels = swarm.actuator("differential_steering")
    left, right = wheels.left / FASTEST, wheels.right / FASTEST
    closest = 1 - np.clip(swarm.sensor("proximity").distance.min(axis=1) / 0.1, 0, 1)
    return float(((left + right) / 2 - 0.5 * abs(left - right) / 2 - closest).mean())


class Learner:
    """A linear network with tanh at its ends, and Adam (Kingma and Ba, 2015) to move its weights."""

    def __init__(self, inputs, outputs, rate, spread, seed):
        self.weights, self.rate, self.spread = np.zeros((outputs, inputs + 1)), rate, spread
        self.random = np.random.default_rng(seed)
        self.mean, self.square, self.updates = np.zeros_like(self.weights), np.zeros_like(self.weights), 0

    @staticmethod
    def with_bias(observations):
        return np.concatenate([observations, np.ones((*observations.shape[:-1], 1))], axis=-1)

    def act(self, observations):
        middle = np.tanh(self.with_bias(observations) @ self.weights.T)
        return middle + self.spread * self.random.standard_normal(middle.shape)

    def learn(self, observations, actions, advantages):
        """All with (steps, worlds, …): moves the weights along the gradient of the expected return."""
        seen = self.with_bias(observations)
        middle = np.tanh(seen @ self.weights.T)
        score = (actions - middle) / self.spread**2 * (1 - middle**2) * advantages[..., None, None]
        gradient = np.einsum("swro,swri->oi", score, seen) / advantages.size
        self.updates += 1
        self.mean += 0.1 * (gradient - self.mean)
        self.square += 0.001 * (gradient**2 - self.square)
        unbiased = np.sqrt(self.square / (1 - 0.999**self.updates)) + 1e-8
        self.weights += self.rate * self.mean / (1 - 0.9**self.updates) / unbiased


def episode(vector, learner, seed):
    """(observations, actions, rewards) of every step."""
    observations, _ = vector.reset(seed=seed)
    steps = []
    while True:
        actions = learner.act(observations)
        after, rewards, terminated, truncated, _ = vector.step(actions)
        steps.append((observations, actions, rewards))
        observations = after
        if (terminated | truncated).all():
            return [np.array(one) for one in zip(*steps)]


def returns(rewards, discount):
    """What each step brings from there on."""
    made = np.zeros_like(rewards)
    rest = 0.0
    for step in reversed(range(len(rewards))):
        rest = made[step] = rewards[step] + discount * rest
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--updates", type=int, default=60)
    parser.add_argument("--worlds", type=int, default=16)
    parser.add_argument("--seconds", type=float, default=10, help="of each episode")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--policy", default="policy.json", help="the file for the network")
    options = parser.parse_args()

    vector = env.VectorEnv(EXPERIMENT, options.worlds, observe=OBSERVE, act=ACT, reward=reward, episode=options.seconds)
    learner = Learner(inputs=8, outputs=2, rate=0.05, spread=0.3, seed=options.seed)
    for update in range(options.updates):
        observations, actions, rewards = episode(vector, learner, seed=options.seed + update * options.worlds)
        gained = returns(rewards, discount=0.8)
        advantages = gained - gained.mean(axis=1, keepdims=True)
        learner.learn(observations, actions, advantages / (advantages.std() + 1e-8))
        print(f"update {update + 1}: mean reward {rewards.mean():.3f}", flush=True)
    vector.save_policy(options.policy, [tandem.Layer(learner.weights[:, :8], learner.weights[:, 8], "tanh")])
    print(f"the network is in {options.policy}; the controller 'neural' runs it")


if __name__ == "__main__":
    main()
