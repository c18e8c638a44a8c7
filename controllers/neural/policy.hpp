// A policy: what a small feed-forward network reads of a robot, what it writes, and its weights. Read from a JSON file:
//
//   {"tandem_policy": 1,
//    "inputs":  [{"port": "proximity", "field": "distance", "first": 0, "count": 8, "low": 0, "high": 0.1,
//                 "scale": 10, "offset": 0}],
//    "outputs": [{"port": "differential_steering", "field": "left", "scale": 0.1}, …],
//    "layers":  [{"weights": [[…], …], "bias": […], "activation": "tanh"}, …]}
//
// An input is scale * clamp(value, low, high) + offset; entries that are not in use, values that are no numbers and
// readings that were never taken count as 0. An output is scale * value + offset, then clamped. `weights` has a row for
// each value of the layer. Lengths and the like are in SI, as in the port.
#pragma once
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace tandem::controllers {

/// `count` elements of a field of a port, from `first` on, and what becomes of each.
struct Signal {
  std::string port, field;
  std::size_t first = 0, count = 1;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  double scale = 1.0, offset = 0.0;
};

enum class Activation { Identity, Relu, Tanh, Sigmoid };

/// One layer: out[i] = activation(bias[i] + sum over j of weights[i * inputs + j] * in[j]), summed from j = 0 on.
struct Layer {
  std::size_t inputs = 0, outputs = 0;
  std::vector<double> weights, bias;
  Activation activation = Activation::Identity;
};

struct Policy {
  std::vector<Signal> inputs, outputs;
  std::vector<Layer> layers;  ///< at least one; their sizes fit one another and the signals
  std::size_t widest = 0;     ///< of all layers and the inputs
};

/// Errors, for people: no JSON; an unknown member; sizes that do not fit; numbers that are not finite.
hal::Result<Policy> parse_policy(std::string_view text);
hal::Result<Policy> read_policy(const std::string& path);

/// The layer's values, with the same bits on every machine. `in` and `out` do not overlap.
void evaluate(const Layer& layer, std::span<const double> in, std::span<double> out) noexcept;

}  // namespace tandem::controllers
