// `tandem robot … --link peer:…`: one robot's controller, run here for a simulation elsewhere, in lock-step.
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <optional>

#include "app/experiment/plugins.hpp"
#include "app/outputs/report.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/process/watchdog.hpp"
#include "app/real/bridged_controller.hpp"
#include "app/real/controller_copy.hpp"
#include "app/real/file_controller.hpp"
#include "app/real/listed_robot.hpp"
#include "app/real/lone_robot.hpp"
#include "app/real/robot_end.hpp"
#include "bridges/link/link_text.hpp"
#include "bridges/peer/peer_side.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

namespace peer = bridges::peer;

constexpr hal::TimeNs kOpenWithin_ns = 30 * hal::kNsPerSecond;  // the hub may start later, or restart its network
constexpr hal::TimeNs kOpenAgain_ns = 100 * hal::kNsPerMs;
constexpr hal::TimeNs kSilent_ns = hal::kNsPerSecond;

/// The controller that a file gives a robot, behind the ports of a hub's robot.
class FilesController final : public peer::PeerController {
 public:
  FilesController(const peer::RobotMessage& robot, const hal::RobotKind& kind,
                  const std::vector<const hal::PortType*>& types, const FileController& file,
                  const hal::PluginLoader& loader, const hal::Log& log)
      : robot_(robot, kind, types),
        listed_(robot_, *file.config, loader.catalog()),
        params_(file.params),
        controller_(*file.type, listed_, params_.get(), robot.ticks_per_second, log, file.who) {
    hal::SourceFilesTaker scripts;
    controller_.controls(scripts);
    copy_ = controller_copy(loader, *file.config, *file.type, scripts.files().value_or(std::vector<hal::SourceFile>()));
  }
  peer::PeerRobot& robot() noexcept override { return robot_; }
  std::optional<peer::ControllerCopy> copy() const override { return copy_; }
  bool step(hal::Tick tick, std::string& why) override { return controller_.step(why, tick); }

 private:
  peer::PeerRobot robot_;
  ListedRobot listed_;
  std::shared_ptr<const void> params_;
  BridgedController controller_;
  peer::ControllerCopy copy_;
};

bool is_one_of(const core::RobotItem& item, const std::string& name) {
  if (!item.distribute) return item.id == name;
  for (std::int64_t i = 0; i < item.distribute->quantity; ++i) {
    if (name == item.id + std::to_string(item.distribute->base_num + i)) return true;
  }
  return false;
}

/// The robot of the file that the hub's is: that of its name, or the only one. Error: neither.
hal::Result<const core::RobotItem*> item_for(const core::Scenario& scenario, const std::string& name) {
  std::string names;
  for (const core::RobotItem& item : scenario.robots) {
    if (is_one_of(item, name)) return &item;
    names += (names.empty() ? "" : ", ") + item.id;
  }
  if (scenario.robots.size() == 1) return scenario.robots.data();
  return hal::Error{"the hub's robot is '" + name + "', and " + scenario.file + " has no such; there are: " + names};
}

/// Which robot to say that this is for; empty: any of the hub's that waits.
std::string wanted_robot(const core::Scenario& scenario, const std::string& said) {
  if (said == "*") return {};
  if (!said.empty()) return said;
  const bool one = scenario.robots.size() == 1 && !scenario.robots.front().distribute;
  return one ? scenario.robots.front().id : std::string();
}

hal::Result<std::unique_ptr<peer::PeerController>> make_controller(const core::Scenario& scenario,
                                                                   hal::PluginLoader& loader, const hal::Log& log,
                                                                   const peer::RobotMessage& robot) {
  const auto found = item_for(scenario, robot.robot);
  if (!found.ok()) return found.error();
  const core::RobotItem& item = *found.value();
  const hal::Catalog& catalog = loader.catalog();
  const hal::RobotKind* const kind =
      item.own_kind != nullptr ? item.own_kind.get() : core::find_kind(scenario, catalog, item.kind);
  if (kind == nullptr || kind->name != robot.kind)
    return hal::Error{"robot '" + robot.robot + "' is of kind '" + robot.kind + "' in the hub, and '" + item.kind +
                      "' in " + scenario.file};
  auto read = read_file_controller(scenario, item, robot.robot, loader);
  if (!read.ok()) return read.error();
  try {
    return std::unique_ptr<peer::PeerController>(
        std::make_unique<FilesController>(robot, *kind, catalog.all<hal::PortType>(), read.value(), loader, log));
  } catch (const std::exception& e) {
    return hal::Error{read.value().who + " " + e.what()};
  }
}

hal::Json report_json(const core::Scenario& scenario, const peer::PeerSide& side, const std::string& link) {
  const peer::PeerCounts counts = side.counts();
  hal::Json json = {{"experiment", scenario.name}, {"link", link},
                    {"steps", counts.ticks},       {"asked_again", counts.asked_again},
                    {"garbled", counts.garbled},   {"not_understood", counts.not_understood},
                    {"links_opened", counts.links}};
  if (side.robot() != nullptr) {
    json["robot"] = side.robot()->robot;
    json["hub_experiment"] = side.robot()->experiment;
    json["seed"] = side.robot()->seed;
  }
  return json;
}

void idle(hal::TimeNs duration_ns, const std::atomic<bool>& stop) {
  for (const hal::TimeNs until = bridges::monotonic_ns() + duration_ns; !stop && bridges::monotonic_ns() < until;) {
    const timespec t{0, 20'000'000};
    ::nanosleep(&t, nullptr);
  }
}

}  // namespace

int robot_peer(const RobotOptions& options) {
  const std::string link_text = options.link.substr(kPeerScheme.size());
  const auto address = bridges::parse_link(link_text);
  if (!address.ok()) return complain(kBadInput, address.error().message);
  const auto opener = bridges::byte_link_opener(address.value());
  if (!opener.ok()) return complain(kBadInput, opener.error().message);
  if (!options.hub_faults.empty())
    return complain(kBadInput, "--hub-fault is for real robots; a peer of a run in lock-step has none");
  hal::PluginLoader loader = make_loader();
  const auto scenario = read_or_complain(loader, options.plugins, options.file, {});
  if (!scenario) return kBadInput;
  if (scenario->robots.empty()) return complain(kBadInput, options.file + " has no robot");
  auto report = open_report(options.report);
  if (!report.ok()) return complain(kBadInput, report.error().message);
  const hal::Log log([](hal::Severity, std::string_view text) { say(text); });
  const std::atomic<bool>& stop = catch_signals();
  std::signal(SIGPIPE, SIG_IGN);
  Watchdog watchdog(options.step_timeout_s, stop);
  peer::PeerSide side(wanted_robot(*scenario, options.robot),
                      [&](const peer::RobotMessage& robot) { return make_controller(*scenario, loader, log, robot); });

  std::unique_ptr<bridges::ByteLink> link;
  std::string failure;
  const std::uint64_t most =
      options.seconds
          ? static_cast<std::uint64_t>(*options.seconds * static_cast<double>(scenario->ticks_per_second) + 0.5)
          : 0;
  hal::TimeNs closed_ns = bridges::monotonic_ns();  // since then there is no link
  bool silent = false, introduced = false;
  while (!stop.load() && !side.ended() && (most == 0 || side.counts().ticks < most)) {
    if (link == nullptr) {
      auto opened = opener.value()();
      if (!opened.ok()) {
        if (bridges::monotonic_ns() - closed_ns >= kOpenWithin_ns) {
          failure = opened.error().message;
          break;
        }
        if (!silent) say(opened.error().message + "; trying on");
        silent = true;
        idle(kOpenAgain_ns, stop);
        continue;
      }
      link = std::move(opened).value();
      silent = false;
      side.link_opened();
    }
    side.pump(*link, bridges::monotonic_ns());
    if (!introduced && side.robot() != nullptr) {
      introduced = true;
      say(fmt::format("controls robot '{}' of {}, seed {}", side.robot()->robot, side.robot()->experiment,
                      side.robot()->seed));
    }
    if (link->state() != bridges::LinkState::Open) {
      closed_ns = bridges::monotonic_ns();
      if (!side.ended()) say("the link " + link->name() + " is lost; trying to open it again");
      link.reset();
      continue;
    }
    const bool waits = bridges::monotonic_ns() - side.heard_ns() >= kSilent_ns;
    if (waits && !silent)
      say(fmt::format("waiting for the hub at {}, after {} ticks", link->name(), side.counts().ticks));
    silent = waits;
    if (!side.ended()) link->wait(50 * hal::kNsPerMs);
  }
  if (link != nullptr && !side.ended()) side.leave(*link, stop ? "interrupted" : "its time is over");
  const peer::PeerCounts counts = side.counts();
  if (side.ended() && side.ended()->error) failure = side.ended()->text;
  RobotEnd end{.failure = failure, .interrupted = stop.load()};
  if (side.ended()) end.how = side.ended()->text;
  if (options.report != "-")
    print_table({{"robot", side.robot() == nullptr ? "none yet" : side.robot()->robot + " at " + link_text},
                 {"ticks", fmt::format("{} answered, {} asked for again", counts.ticks, counts.asked_again)},
                 {"ended", end.failure.empty() ? end.word() : end.failure}});
  return end_robot(report.value(), report_json(*scenario, side, link_text), end);
}

}  // namespace tandem::app
