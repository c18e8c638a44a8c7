// A robot of another program's world as its controller sees it here: ports that messages fill and empty.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/peer/messages.hpp"
#include "bridges/port_bank.hpp"
#include "hal/robot.hpp"

namespace tandem::bridges::peer {

class PeerRobot final : public hal::Robot {
 public:
  /// `types`: descriptions by which a controller here may ask for ports; those that the hub's robot has in another
  /// form, or not at all, are not given. They and `kind` must outlive this.
  PeerRobot(const RobotMessage& robot, const hal::RobotKind& kind, std::span<const hal::PortType* const> types);

  std::string_view id() const noexcept override { return robot_.robot; }
  const hal::RobotKind& kind() const noexcept override { return kind_; }
  std::uint64_t run_seed() const noexcept override { return robot_.seed; }

  /// @throws hal::DeviceError
  void* require(const hal::PortType& type) { return take(type); }
  /// A member of the controller is published.
  void published(hal::PublishedField field, const void* member) { show(std::move(field), member); }

  /// What was taken and published so far.
  Ready ready() const;

  /// Takes readings, and commands where they follow. False: these are not of this robot's form.
  bool take_readings(std::span<const std::uint8_t> payload, std::uint8_t flags);
  /// Adds commands and what is published.
  void give_commands(std::vector<std::uint8_t>& out) const;

 protected:
  void* take(const hal::PortType& type) override;
  void show(hal::PublishedField field, const void* member) override;

 private:
  struct Taken {
    PortName name;
    RowForm form;
    void* data;
  };
  struct Shown {
    PublishedForm form;
    const void* member;
    std::size_t bytes;
  };

  RobotMessage robot_;
  const hal::RobotKind& kind_;
  PortBank bank_;
  std::vector<Taken> taken_;
  std::vector<Shown> shown_;
};

}  // namespace tandem::bridges::peer
