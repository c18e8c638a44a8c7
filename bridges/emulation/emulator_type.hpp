// Interface of a kind of emulators: programs that behave as a robot's firmware on a link.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/port_bank.hpp"
#include "hal/log.hpp"
#include "hal/params.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::bridges {

/// Options of every emulator.
struct EmulatorRequest {
  std::string link;
  std::string log_file = {};                 ///< one JSON object a line; empty: none
  std::vector<std::string> faults = {};      ///< as the emulator reads them
  std::shared_ptr<const void> options = {};  ///< what `EmulatorType::read` gave; null: all left out
  hal::Log log = {};                         ///< for people
  /// Called once, when a host can connect: with what is there, and how it is reached.
  std::function<void(const std::string& text)> ready = {};
};

struct EmulatorType {
  static constexpr std::string_view kCategory = "emulator";
  using Crosses = hal::Layouts<EmulatorRequest, SharedPorts, PortBank, hal::PortType, hal::ParamVisitor, hal::Log>;
  std::string_view name;  ///< for the command line
  std::string_view kind;  ///< of robots
  std::string_view summary;
  /// A controller under which a simulated robot may be the body, as `label library`, for advice.
  std::string_view puppet;
  /// The ports that a simulated robot's controller must have taken to be the body, and all that are used.
  std::vector<const hal::PortType*> (*needs)() = nullptr;
  std::vector<const hal::PortType*> (*ports)() = nullptr;
  /// What may go wrong with it, as `EmulatorRequest::faults` are written; null: nothing.
  std::string (*faults)() = nullptr;
  /// Its own options, with their defaults.
  std::shared_ptr<const void> (*read)(hal::ParamVisitor& visitor) = nullptr;
  /// Emulates until `stop` becomes true, which is noticed within 20 ms. `body` must outlive the call; null: a body of
  /// its own. Errors: a link, log, option or fault that there is not, a link that goes away.
  hal::Status (*run)(const EmulatorRequest& request, SharedPorts* body, const std::atomic<bool>& stop) = nullptr;
};

/// For `EmulatorType::read`.
template <hal::Described Options>
std::shared_ptr<const void> read_options(hal::ParamVisitor& visitor) {
  auto options = std::make_shared<Options>();
  options->describe(visitor);
  return options;
}

}  // namespace tandem::bridges
