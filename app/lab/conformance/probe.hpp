// A controller that takes the devices of its configuration, and commands them at random.
#pragma once
#include <string_view>
#include <vector>

#include "hal/catalog.hpp"
#include "hal/port.hpp"
#include "hal/random.hpp"

namespace tandem::app {

/// As files name it, with the library `hal::Catalog::kInside`.
inline constexpr std::string_view kProbe = "probe";

/// Adds the controller. Those that are constructed take `ports`, which must outlive them. One at a time.
void register_probe(hal::Registrar& registrar);
void set_probe_ports(const std::vector<const hal::PortType*>& ports);

/// Fills a command with numbers drawn from `random`, most of them of the size that devices understand, some far beyond
/// and some that are none.
void command_at_random(const hal::PortType& type, void* command, hal::Random& random);

}  // namespace tandem::app
