"""Experiments for tests."""

import os

CONFIGS = os.environ["TANDEM_CONFIGS"]
DIFFUSION = os.path.join(CONFIGS, "epuck_diffusion.xml")
FOOTBOTS = os.path.join(CONFIGS, "footbot_diffusion.xml")


def wall(name, size, position):
    return {"id": name, "size": size, "movable": False, "body": {"position": position}}


def room(robots=6, side=2.0, **experiment):
    """E-pucks in a square room, under diffusion."""
    half, long = side / 2, (0.1, side, 0.5)
    return {
        "framework": {"experiment": {"length": 20, "ticks_per_second": 10, "random_seed": 3, **experiment}},
        "controllers": {"epuck_diffusion": {
            "id": "d", "library": "epuck_diffusion",
            "actuators": {"differential_steering": {}, "leds": {}}, "sensors": {"proximity": {}}, "params": {"velocity": "5 cm/s"}}},
        "arena": {
            "size": (side + 0.2, side + 0.2, 1.0),
            "box": [wall("west", long, (-half, 0, 0)), wall("east", long, (half, 0, 0)),
                    wall("south", (side, 0.1, 0.5), (0, -half, 0)), wall("north", (side, 0.1, 0.5), (0, half, 0))],
            "distribute": {
                "position": {"method": "uniform", "min": (0.2 - half, 0.2 - half, 0), "max": (half - 0.2, half - 0.2, 0)},
                "orientation": {"method": "uniform", "min": (0, 0, 0), "max": (360, 0, 0)},
                "entity": {"quantity": robots, "max_trials": 1000, "e-puck": {"id": "ep", "controller": {"config": "d"}}}}},
        "physics_engines": {"kinematics2d": {"id": "kin"}},
    }
