// Controller that runs a small network: readings in, commands out. The weights come from a file (policy.hpp), as
// `tandem.save_policy` of Python writes it.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "controllers/neural/policy.hpp"
#include "hal/controller.hpp"
#include "hal/port.hpp"

namespace tandem::controllers {

class PolicyFile;  // neural.cpp: read once for all robots of a configuration

/// Has no state but its ports: the same readings give the same commands, to the last bit, on every machine.
class Neural final : public hal::Controller {
 public:
  struct Params {
    Params();
    std::string policy;
    std::shared_ptr<PolicyFile> file;
    void describe(hal::ParamVisitor& v);
  };

  /// @throws std::runtime_error when the file is none, or names what the robot's configuration does not list
  Neural(hal::Robot& robot, const Params& params);

  void step() noexcept override;
  bool reset(hal::Robot& robot) override;

 private:
  /// A signal at its place in the robot.
  struct Tap {
    void* port = nullptr;
    const hal::PortType* type = nullptr;
    const hal::Field* field = nullptr;
  };
  std::vector<Tap> tap(hal::Robot& robot, const std::vector<Signal>& signals, hal::Role role) const;

  std::shared_ptr<const Policy> policy_;
  std::vector<Tap> inputs_, outputs_;
  std::vector<double> values_, next_;
};

}  // namespace tandem::controllers
