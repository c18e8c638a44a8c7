#include "app/command/command.hpp"
#include "app/command/listing.hpp"
#include "app/real/register.hpp"
#include "bridges/bridge_type.hpp"
#include "bridges/emulation/emulator_type.hpp"
#include "bridges/epuck/register.hpp"
#include "bridges/epuck_emulator/register.hpp"
#include "bridges/eyebot/register.hpp"
#include "bridges/eyebot_emulator/register.hpp"
#include "bridges/footbot/register.hpp"
#include "bridges/footbot_emulator/register.hpp"
#include "bridges/tag_tracker/register.hpp"
#include "bridges/thymio/register.hpp"
#include "bridges/thymio_emulator/register.hpp"
#include "bridges/tracker_emulator/register.hpp"
#include "bridges/tracker_type.hpp"
#include "bridges/trackers/register.hpp"
#include "bridges/wired/register.hpp"
#include "core/config/manual.hpp"
#include "mixed_reality/record_tracker/record_tracker.hpp"

namespace tandem::app {
namespace {

/// An emulator, and what the command line may say to it.
bool describe_emulator(const hal::Catalog& catalog, const std::string& name) {
  const auto* const type = catalog.find<bridges::EmulatorType>(name);
  if (type == nullptr) return false;
  fmt::print("emulator {}: {}{}\n", name, type->summary, from(catalog, type));
  if (!type->kind.empty()) fmt::print("  its body in an --arena: an {} under {}\n", type->kind, type->puppet);
  core::ManualWriter manual;
  (void)type->read(manual);
  fmt::print("options, written --name value:\n{}", manual.text().empty() ? "  none\n" : manual.text());
  if (type->faults != nullptr) fmt::print("faults, written --fault TEXT:\n{}\n", type->faults());
  return true;
}

constexpr Listing kListings[] = {
    {"bridges", [](const hal::Catalog& c) { list_entries<bridges::BridgeType>(c, "bridges to real robots"); }},
    {"emulators", [](const hal::Catalog& c) { list_entries<bridges::EmulatorType>(c, "emulators"); },
     &describe_emulator},
    {"trackers", [](const hal::Catalog& c) { list_entries<bridges::TrackerType>(c, "trackers of real robots"); }}};

}  // namespace

void register_real(hal::Registrar& registrar) {
  registrar.know(hal::SurfaceOf<bridges::TrackerType>::value());
  for (const hal::CommandType* type :
       {&replay_command, &preflight_command, &desk_command, &robot_command, &inspect_command, &emulate_command})
    registrar.add(*type);
  bridges::epuck::register_bridge(registrar);
  bridges::footbot::register_bridge(registrar);
  bridges::eyebot::register_bridge(registrar);
  bridges::thymio::register_bridge(registrar);
  bridges::epuck_emulator::register_emulator(registrar);
  bridges::footbot_emulator::register_emulator(registrar);
  bridges::eyebot_emulator::register_emulator(registrar);
  bridges::thymio_emulator::register_emulator(registrar);
  bridges::wired::register_wired_robots(registrar);
  bridges::trackers::register_trackers(registrar);
  bridges::tag_tracker::register_tracker(registrar);
  mixed_reality::register_record_tracker(registrar);
  bridges::tracker_emulator::register_emulator(registrar);
  for (const Listing& listing : kListings) registrar.add(listing);
  register_real_side(registrar);
}

}  // namespace tandem::app
