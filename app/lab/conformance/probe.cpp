#include "app/lab/conformance/probe.hpp"

#include <cmath>
#include <limits>

#include "hal/controller.hpp"

namespace tandem::app {
namespace {

const std::vector<const hal::PortType*>* wanted = nullptr;  // a table of functions has nowhere else to keep it

/// Takes ports by their description.
struct Taker : hal::Robot {
  static void* take_of(hal::Robot& robot, const hal::PortType& type) { return (robot.*&Taker::take)(type); }
};

class Probe final : public hal::Controller {
 public:
  explicit Probe(hal::Robot& robot) : random_(robot.random()) {
    for (const hal::PortType* type : *wanted) {
      void* const port = Taker::take_of(robot, *type);
      if (type->role == hal::Role::Actuator) commands_.push_back({type, port});
    }
  }
  void step() override {
    for (const Command& c : commands_) command_at_random(*c.type, c.port, random_);
  }

 private:
  struct Command {
    const hal::PortType* type;
    void* port;
  };
  std::vector<Command> commands_;
  hal::Random random_;
};

double number_at_random(hal::Random& random) {
  switch (random.integer(0, 19)) {
    case 0:
      return random.uniform(-1e6, 1e6);
    case 1:
      return std::numeric_limits<double>::quiet_NaN();
    case 2:
      return 0.0;
    default:
      return random.uniform(-1.0, 1.0) * (random.chance(0.5) ? 0.1 : 1.0);
  }
}

}  // namespace

void register_probe(hal::Registrar& registrar) {
  registrar.add_controller<Probe>(kProbe, "Takes devices, and commands them at random.");
}

void set_probe_ports(const std::vector<const hal::PortType*>& ports) {
  wanted = &ports;
}

void command_at_random(const hal::PortType& type, void* command, hal::Random& random) {
  for (const hal::Field& field : type.fields) {
    const bool real = field.scalar == hal::Scalar::F32 || field.scalar == hal::Scalar::F64;
    for (std::size_t i = 0; i < field.count; ++i)
      hal::set_value(command, field, i, real ? number_at_random(random) : static_cast<double>(random.integer(0, 3)));
  }
}

}  // namespace tandem::app
