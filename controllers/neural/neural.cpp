#include "controllers/neural/neural.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "hal/device_list.hpp"
#include "hal/open_params.hpp"

namespace tandem::controllers {
namespace {

/// A value that the scalar can hold.
double held_by(hal::Scalar scalar, double value) noexcept {
  const auto within = [value](double low, double high) {
    return std::isnan(value) ? 0.0 : std::clamp(std::floor(value + 0.5), low, high);
  };
  switch (scalar) {
    case hal::Scalar::F32:
    case hal::Scalar::F64:
      return value;
    case hal::Scalar::Bool:
      return value > 0.5 ? 1.0 : 0.0;
    case hal::Scalar::U8:
      return within(0.0, 255.0);
    case hal::Scalar::U16:
      return within(0.0, 65535.0);
    case hal::Scalar::U32:
      return within(0.0, 4294967295.0);
    case hal::Scalar::I32:
      return within(-2147483648.0, 2147483647.0);
    case hal::Scalar::I64:
      return within(-9e15, 9e15);
  }
  return value;
}

}  // namespace

class PolicyFile {
 public:
  std::shared_ptr<const Policy> read(const std::string& path) {
    const std::lock_guard hold(lock_);
    if (policy_ != nullptr && path_ == path) return policy_;
    if (path.empty()) throw std::runtime_error("has no policy; say which: <params policy=\"policy.json\"/>");
    auto found = read_policy(path);
    if (!found.ok()) throw std::runtime_error(found.error().message);
    path_ = path;
    policy_ = std::make_shared<const Policy>(std::move(found).value());
    return policy_;
  }

 private:
  std::mutex lock_;
  std::string path_;
  std::shared_ptr<const Policy> policy_;
};

Neural::Params::Params() : file(std::make_shared<PolicyFile>()) {}

void Neural::Params::describe(hal::ParamVisitor& v) {
  hal::describe_file(v, "policy", policy, "The network, as tandem.save_policy writes it (docs/python.md).");
}

Neural::Neural(hal::Robot& robot, const Params& params)
    : policy_(params.file->read(params.policy)),
      inputs_(tap(robot, policy_->inputs, hal::Role::Sensor)),
      outputs_(tap(robot, policy_->outputs, hal::Role::Actuator)),
      values_(policy_->widest),
      next_(policy_->widest) {}

std::vector<Neural::Tap> Neural::tap(hal::Robot& robot, const std::vector<Signal>& signals, hal::Role role) const {
  auto* const list = dynamic_cast<hal::DeviceList*>(&robot);
  if (list == nullptr) throw hal::DeviceError("is in a world that does not tell which devices its configuration lists");
  const std::vector<hal::ListedDevice> devices = list->devices();
  std::vector<Tap> taps;
  for (const Signal& signal : signals) {
    const auto device = std::find_if(devices.begin(), devices.end(), [&](const hal::ListedDevice& d) {
      return d.port->role == role && d.port->name == signal.port;
    });
    const std::string kind = role == hal::Role::Sensor ? "sensor" : "actuator";
    if (device == devices.end()) {
      throw hal::DeviceError("has a policy with the " + kind + " '" + signal.port +
                             "', which its configuration does not list; add <" + signal.port + "/> to its <" + kind +
                             "s>");
    }
    const hal::PortType& type = *device->port;
    const hal::Field* const field = type.field(signal.field);
    if (field == nullptr || signal.first + signal.count > field->count) {
      std::string known;
      for (const hal::Field& f : type.fields)
        known += (known.empty() ? "" : ", ") + std::string(f.name) +
                 (f.count > 1 ? "[" + std::to_string(f.count) + "]" : "");
      throw hal::DeviceError("has a policy with the field '" + signal.field + "' of '" + signal.port + "', elements " +
                             std::to_string(signal.first) + " to " + std::to_string(signal.first + signal.count - 1) +
                             ", which it does not have; it has: " + known);
    }
    taps.push_back({list->port(type), &type, field});
  }
  return taps;
}

void Neural::step() noexcept {
  std::size_t at = 0;
  for (std::size_t s = 0; s < inputs_.size(); ++s) {
    const Signal& signal = policy_->inputs[s];
    const Tap& tap = inputs_[s];
    const bool taken = static_cast<const hal::Reading*>(tap.port)->validity != hal::Validity::Absent;
    const std::size_t used = taken ? hal::used_count(*tap.type, tap.port, *tap.field) : 0;
    for (std::size_t i = signal.first; i < signal.first + signal.count; ++i, ++at) {
      const double value = i < used ? hal::get_value(tap.port, *tap.field, i) : std::nan("");
      values_[at] = std::isnan(value) ? 0.0 : signal.scale * std::clamp(value, signal.low, signal.high) + signal.offset;
    }
  }
  for (const Layer& layer : policy_->layers) {
    evaluate(layer, values_, next_);
    values_.swap(next_);
  }
  at = 0;
  for (std::size_t s = 0; s < outputs_.size(); ++s) {
    const Signal& signal = policy_->outputs[s];
    for (std::size_t i = signal.first; i < signal.first + signal.count; ++i, ++at)
      hal::set_value(outputs_[s].port, *outputs_[s].field, i,
                     held_by(outputs_[s].field->scalar,
                             std::clamp(signal.scale * values_[at] + signal.offset, signal.low, signal.high)));
  }
}

bool Neural::reset(hal::Robot& /*robot*/) {
  return true;
}

}  // namespace tandem::controllers
