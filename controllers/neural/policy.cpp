#include "controllers/neural/policy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>

#include "hal/elementary.hpp"
#include "hal/input_file.hpp"
#include "hal/json/json.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::controllers {
namespace {

using hal::Json;

constexpr std::size_t kMostValues = 4096;  // of a layer: a small network

hal::Error error(const std::string& where, const std::string& what) {
  return hal::Error{where + " " + what};
}

/// A number of the object, finite; `fallback` where it is absent or null.
hal::Status read_number(const Json& object, const char* name, const std::string& where, double& value) {
  const auto found = object.find(name);
  if (found == object.end() || found->is_null()) return {};
  if (!found->is_number() || !std::isfinite(found->get<double>()))
    return error(where, "has a '" + std::string(name) + "' that is no finite number");
  value = found->get<double>();
  return {};
}

hal::Status read_count(const Json& object, const char* name, const std::string& where, std::size_t& value) {
  const auto found = object.find(name);
  if (found == object.end()) return {};
  if (!found->is_number_unsigned() || found->get<std::uint64_t>() > kMostValues)
    return error(where, "has a '" + std::string(name) + "' that is no number of elements");
  value = found->get<std::size_t>();
  return {};
}

hal::Status only(const Json& object, const std::string& where, std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : object.items()) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      return error(where, "has '" + name + "', which is unknown");
  }
  return {};
}

hal::Status read_signals(const Json& file, const char* name, std::vector<Signal>& signals) {
  const auto list = file.find(name);
  if (list == file.end() || !list->is_array() || list->empty())
    return error("the policy", "has no list '" + std::string(name) + "'");
  for (const Json& one : *list) {
    const std::string where = "'" + std::string(name) + "' " + std::to_string(signals.size());
    if (!one.is_object()) return error(where, "is no object");
    Signal signal;
    for (const auto& [member, text] :
         {std::pair<const char*, std::string*>{"port", &signal.port}, {"field", &signal.field}}) {
      const auto found = one.find(member);
      if (found == one.end() || !found->is_string()) return error(where, "names no '" + std::string(member) + "'");
      *text = found->get<std::string>();
    }
    hal::Status good = only(one, where, {"port", "field", "first", "count", "low", "high", "scale", "offset"});
    if (good.ok()) good = read_count(one, "first", where, signal.first);
    if (good.ok()) good = read_count(one, "count", where, signal.count);
    if (good.ok()) good = read_number(one, "low", where, signal.low);
    if (good.ok()) good = read_number(one, "high", where, signal.high);
    if (good.ok()) good = read_number(one, "scale", where, signal.scale);
    if (good.ok()) good = read_number(one, "offset", where, signal.offset);
    if (!good.ok()) return good;
    if (signal.count == 0) return error(where, "has no elements");
    if (!(signal.low <= signal.high)) return error(where, "has a 'low' above its 'high'");
    signals.push_back(std::move(signal));
  }
  return {};
}

hal::Status read_numbers(const Json& list, const std::string& where, std::vector<double>& numbers) {
  if (!list.is_array()) return error(where, "is no list of numbers");
  for (const Json& one : list) {
    if (!one.is_number() || !std::isfinite(one.get<double>()))
      return error(where, "has something that is no finite number");
    numbers.push_back(one.get<double>());
  }
  return {};
}

hal::Status read_layer(const Json& one, const std::string& where, std::size_t inputs, Layer& layer) {
  if (!one.is_object() || !one.contains("weights") || !one.contains("bias") || !one["weights"].is_array())
    return error(where, "needs 'weights' and 'bias'");
  hal::Status good = only(one, where, {"weights", "bias", "activation"});
  if (!good.ok()) return good;
  layer.inputs = inputs;
  layer.outputs = one["weights"].size();
  if (layer.outputs == 0 || layer.outputs > kMostValues)
    return error(where, "has " + std::to_string(layer.outputs) + " values; 1 to " + std::to_string(kMostValues) +
                            " are possible");
  for (const Json& row : one["weights"]) {
    const std::size_t before = layer.weights.size();
    good = read_numbers(row, where + ": a row of 'weights'", layer.weights);
    if (!good.ok()) return good;
    if (layer.weights.size() - before != inputs)
      return error(where, "has a row of " + std::to_string(layer.weights.size() - before) + " weights, but " +
                              std::to_string(inputs) + " values come in");
  }
  good = read_numbers(one["bias"], where + ": 'bias'", layer.bias);
  if (!good.ok()) return good;
  if (layer.bias.size() != layer.outputs)
    return error(
        where, "has " + std::to_string(layer.bias.size()) + " biases for " + std::to_string(layer.outputs) + " values");
  const std::string activation = hal::text_of(one, "activation");
  if (activation == "identity") {
    layer.activation = Activation::Identity;
  } else if (activation == "relu") {
    layer.activation = Activation::Relu;
  } else if (activation == "tanh") {
    layer.activation = Activation::Tanh;
  } else if (activation == "sigmoid") {
    layer.activation = Activation::Sigmoid;
  } else {
    return error(where, "has no 'activation'; there are identity, relu, tanh, sigmoid");
  }
  return {};
}

std::size_t values_of(const std::vector<Signal>& signals) {
  std::size_t all = 0;
  for (const Signal& signal : signals) all += signal.count;
  return all;
}

double activated(Activation activation, double x) noexcept {
  switch (activation) {
    case Activation::Identity:
      break;
    case Activation::Relu:
      return x > 0.0 ? x : 0.0;
    case Activation::Tanh: {
      const double t = 1.0 - 2.0 / (hal::exp(2.0 * std::fabs(x)) + 1.0);
      return x < 0.0 ? -t : t;
    }
    case Activation::Sigmoid:
      return 1.0 / (1.0 + hal::exp(-x));
  }
  return x;
}

}  // namespace

hal::Result<Policy> parse_policy(std::string_view text) {
  auto parsed = hal::parse_json_object(text);
  if (!parsed.ok()) return parsed.error();
  const Json& file = parsed.value();
  if (!file.contains("tandem_policy") || file["tandem_policy"] != 1)
    return hal::Error{"is no policy of this version: it begins with \"tandem_policy\": 1"};
  Policy policy;
  hal::Status good = only(file, "the policy", {"tandem_policy", "inputs", "outputs", "layers"});
  if (good.ok()) good = read_signals(file, "inputs", policy.inputs);
  if (good.ok()) good = read_signals(file, "outputs", policy.outputs);
  if (!good.ok()) return good.error();
  if (!file.contains("layers") || !file["layers"].is_array() || file["layers"].empty())
    return hal::Error{"the policy has no list 'layers'"};
  std::size_t values = values_of(policy.inputs);
  policy.widest = values;
  for (const Json& one : file["layers"]) {
    Layer layer;
    good = read_layer(one, "layer " + std::to_string(policy.layers.size()), values, layer);
    if (!good.ok()) return good.error();
    values = layer.outputs;
    policy.widest = std::max(policy.widest, values);
    policy.layers.push_back(std::move(layer));
  }
  if (values != values_of(policy.outputs))
    return hal::Error{"the last layer has " + std::to_string(values) + " values for " +
                      std::to_string(values_of(policy.outputs)) + " outputs"};
  return policy;
}

hal::Result<Policy> read_policy(const std::string& path) {
  const auto text = hal::read_whole_file(path, "cannot read the policy");
  if (!text.ok()) return text.error();
  auto policy = parse_policy(text.value());
  if (!policy.ok()) return hal::Error{"policy '" + path + "': " + policy.error().message};
  return policy;
}

void evaluate(const Layer& layer, std::span<const double> in, std::span<double> out) noexcept {
  const double* weights = layer.weights.data();
  for (std::size_t i = 0; i < layer.outputs; ++i, weights += layer.inputs) {
    double sum = layer.bias[i];
    for (std::size_t j = 0; j < layer.inputs; ++j) sum += weights[j] * in[j];
    out[i] = activated(layer.activation, sum);
  }
}

}  // namespace tandem::controllers
