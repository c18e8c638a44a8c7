#include "mixed_reality/lockstep/lockstep.hpp"

#include <algorithm>
#include <array>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

#include "bridges/link/link_text.hpp"
#include "bridges/link/tcp_link.hpp"
#include "hal/check.hpp"
#include "hal/unit.hpp"
#include "mixed_reality/settings/peer_check.hpp"

namespace tandem::mixed_reality {
namespace {

namespace peer = bridges::peer;

constexpr std::size_t kMostVisitors = 64;
constexpr hal::TimeNs kVisitorsSay_ns = 3 * hal::kNsPerSecond;
constexpr int kLookEvery_ms = 50;  // at `stop`, and at links that must be opened

/// "192.168.1.20:40312", of whoever has connected.
std::string name_of_peer(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  const bool known = ::getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
                     ::getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host.data(), host.size(),
                                   port.data(), port.size(), NI_NUMERICHOST | NI_NUMERICSERV) == 0;
  return known ? std::string(host.data()) + ":" + port.data() : std::string("?");
}

std::string seconds(hal::TimeNs t) {
  return hal::format_number(static_cast<double>(t / (100 * hal::kNsPerMs)) / 10.0) + " s";
}

}  // namespace

// --- making one ---

LockstepRun::LockstepRun(core::World& world, const LockstepOptions& options) : world_(world), options_(options) {}

hal::Result<std::unique_ptr<LockstepRun>> LockstepRun::make(core::World& world, const LockstepOptions& options) {
  std::unique_ptr<LockstepRun> run(new LockstepRun(world, options));
  const core::Scenario& scenario = world.scenario();
  // Tells this run from others; no number of the simulation depends on it.
  const std::string session = std::to_string(::getpid()) + "-" + std::to_string(bridges::monotonic_ns());
  core::Space& space = world.space();
  for (const core::RobotItem& item : scenario.robots) {
    if (!item.peer) continue;
    for (std::int64_t i = 0; i < (item.distribute ? item.distribute->quantity : 1); ++i) {
      const std::string name = item.distribute ? item.id + std::to_string(item.distribute->base_num + i) : item.id;
      const core::RobotId robot = space.find_robot(name);
      TANDEM_CHECK(robot.valid(), "a robot of the file is in its world");
      if (const hal::Status added = run->add(item, robot, session); !added.ok())
        return hal::Error{scenario.file + ":" + std::to_string(item.peer->line) + ": error: robot '" + name +
                          "': " + added.error().message};
    }
  }
  const bool come = std::ranges::any_of(
      run->rows_, [](const Row& row) { return row.remote != nullptr && !row.remote->opens_its_link(); });
  if (come) {
    auto listener = bridges::Listener::open("tcp", "tcp", scenario.lockstep.listen);
    if (!listener.ok())
      return hal::Error{scenario.file + ":" + std::to_string(scenario.lockstep.line) +
                        ": error: <peers listen>: " + listener.error().message};
    run->listener_ = std::move(listener).value();
  }
  for (const Row& row : run->rows_) world.set_steps_elsewhere(row.partner->robot(), true);
  world.set_external(run.get());
  return run;
}

hal::Status LockstepRun::add(const core::RobotItem& item, core::RobotId robot, const std::string& session) {
  Row row;
  row.name = world_.space().robot_name(robot);
  const std::string& link = item.peer->link;
  if (is_emulated(*item.peer)) {
    if (!options_.make_emulated) return hal::Error{"nobody makes emulated robots here"};
    auto made = options_.make_emulated(world_, robot,
                                       link.size() > kEmulatedPeer.size() ? link.substr(kEmulatedPeer.size() + 1) : "");
    if (!made.ok()) return made.error();
    row.partner = std::move(made).value();
  } else {
    bridges::LinkOpener open;
    if (!link.empty()) {
      const auto address = bridges::parse_link(link);
      if (!address.ok()) return address.error();
      auto opener = bridges::byte_link_opener(address.value());
      if (!opener.ok()) return opener.error();
      open = std::move(opener).value();
    }
    auto remote = std::make_unique<RemotePeer>(world_, robot, session, std::move(open), options_.log);
    if (options_.copy_of) remote->compare_with(options_.copy_of(world_, robot));
    row.remote = remote.get();
    row.partner = std::move(remote);
  }
  rows_.push_back(std::move(row));
  return {};
}

LockstepRun::~LockstepRun() {
  finish(true, "the hub ended");
  world_.set_external(nullptr);
}

// --- waiting ---

template <class Waiting>
std::string LockstepRun::missing(const Waiting& waiting) const {
  constexpr std::size_t kNamed = 8;
  std::string text;
  std::size_t count = 0;
  for (const Row& row : rows_) {
    if (!waiting(row) || ++count > kNamed) continue;
    text += (text.empty() ? "'" : ", '") + row.name + "' (" + row.partner->trouble() + ")";
  }
  return count > kNamed ? text + " and " + std::to_string(count - kNamed) + " more" : text;
}

/// Until no row waits. Says after a second who is missing, and then from time to time.
template <class Waiting>
LockstepRun::Waited LockstepRun::wait_for(const char* what, const Waiting& waiting) {
  const auto any = [&] { return std::ranges::any_of(rows_, waiting); };
  const hal::TimeNs began_ns = now();
  const auto timeout_ns = static_cast<hal::TimeNs>(world_.scenario().lockstep.timeout_s * 1e9);
  hal::TimeNs name_ns = began_ns + kNameAfter_ns;
  bool named = false;
  Waited result = Waited::Done;
  for (look_after_links(0); any(); look_after_links(kLookEvery_ms)) {
    const hal::TimeNs waited_ns = now() - began_ns;
    if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
      result = Waited::Stopped;
      break;
    }
    if (waited_ns >= timeout_ns) {
      result = Waited::TimedOut;
      break;
    }
    if (began_ns + waited_ns < name_ns) continue;
    if (!named) ++waits_;
    named = true;
    name_ns = began_ns + waited_ns + kNameAgain_ns;
    options_.log.warning(std::string(what) + " for " + seconds(waited_ns) + ": robot " + missing(waiting));
  }
  const hal::TimeNs waited_ns = now() - began_ns;
  waited_ns_ += waited_ns;
  if (named && result == Waited::Done) options_.log.info("all peers are there again, after " + seconds(waited_ns));
  return result;
}

/// Reads what has come on every link; waits for that at most so long.
void LockstepRun::look_after_links(int timeout_ms) {
  std::vector<pollfd> polled;
  polled.reserve(rows_.size() + visitors_.size() + 1);
  const auto add = [&](int descriptor) {
    if (descriptor >= 0) polled.push_back({descriptor, POLLIN, 0});
  };
  if (listener_ != nullptr) add(listener_->descriptor());
  for (const Row& row : rows_) add(row.gone || row.simulated ? -1 : row.partner->descriptor());
  for (const Visitor& visitor : visitors_) add(visitor.link->descriptor());
  if (timeout_ms > 0) (void)::poll(polled.data(), polled.size(), timeout_ms);
  let_in();
  const hal::TimeNs at_ns = now();
  for (Row& row : rows_) {
    if (!row.gone && !row.simulated) row.partner->pump(at_ns);
  }
}

void LockstepRun::let_in() {
  if (listener_ == nullptr) return;
  for (int socket = listener_->accept(); socket >= 0; socket = listener_->accept()) {
    auto link = bridges::TcpLink::take_over("tcp:" + name_of_peer(socket), socket);
    if (visitors_.size() < kMostVisitors)
      visitors_.push_back({std::move(link), {}, now()});
    else
      ++strangers_;
  }
  std::erase_if(visitors_, [this](Visitor& visitor) { return admit(visitor); });
}

/// @returns whether the visitor is none any more: it has a robot, was refused, or says nothing
bool LockstepRun::admit(Visitor& visitor) {
  std::array<std::uint8_t, 1024> buffer;
  const bridges::Received got = visitor.link->read(buffer);
  visitor.reader.push(std::span(buffer).first(got.size));
  const auto frame = visitor.reader.next();
  if (!frame) {
    const bool silent = now() - visitor.since_ns >= kVisitorsSay_ns;
    if (!silent && visitor.link->state() == bridges::LinkState::Open) return false;
    ++strangers_;
    return true;
  }
  std::string why = "it did not say Hello";
  if (frame->type == peer::MessageType::Hello) {
    const auto hello = peer::read_hello(frame->payload);
    RemotePeer* const found = hello.ok() ? peer_for(hello.value(), why) : nullptr;
    if (!hello.ok()) why = hello.error().message;
    if (found != nullptr) {
      found->take_over(std::move(visitor.link), now());  // which waits for our answer before it says more
      return true;
    }
  }
  ++strangers_;
  options_.log.warning("a peer at " + visitor.link->name() + " is refused: " + why);
  const auto end = peer::frame_of(peer::MessageType::End, peer::bytes_of(peer::Farewell{true, why}));
  (void)visitor.link->write(end, 100 * hal::kNsPerMs);
  return true;
}

/// Null: none; `why` then says why.
RemotePeer* LockstepRun::peer_for(const peer::Hello& hello, std::string& why) {
  std::string names;
  for (Row& row : rows_) {
    if (row.remote == nullptr || row.remote->opens_its_link()) continue;
    names += (names.empty() ? "" : ", ") + row.name;
    if (!hello.robot.empty() && hello.robot != row.name) continue;
    row.remote->pump(now());  // the one before may have hung up meanwhile
    if (hello.robot.empty() && (!row.remote->free() || row.gone || row.simulated)) continue;
    why = row.gone        ? "robot '" + row.name + "' was removed from the run"
          : row.simulated ? "robot '" + row.name + "' is simulated by now: its peer was missing for too long"
          : !row.remote->free() && hello.session.empty() ? "robot '" + row.name + "' has a peer already"
                                                         : "";
    if (why.empty()) {
      const hal::Status good = row.remote->judge(hello);
      if (!good.ok()) why = good.error().message;
    }
    return why.empty() ? row.remote : nullptr;
  }
  why = hello.robot.empty() ? "every robot with a <peer> has one already"
                            : "no robot '" + hello.robot + "' waits for a peer here; there are: " + names;
  return nullptr;
}

hal::Status LockstepRun::connect() {
  const auto waiting = [](const Row& row) { return !row.gone && !row.simulated && !row.partner->ready(); };
  const Waited waited = wait_for("waiting for peers", waiting);
  if (waited == Waited::Done) return {};
  if (waited == Waited::Stopped) return hal::Error{"interrupted while waiting for peers: robot " + missing(waiting)};
  const std::string late = " after " + seconds(static_cast<hal::TimeNs>(world_.scenario().lockstep.timeout_s * 1e9));
  if (!world_.scenario().lockstep.simulate_missing)
    return hal::Error{"peers are missing" + late + ": robot " + missing(waiting)};
  for (Row& row : rows_) {
    if (waiting(row)) simulate(row, "its peer is missing" + late + " (" + row.partner->trouble() + ")");
  }
  return {};
}

/// From here on its controller steps in the hub.
void LockstepRun::simulate(Row& row, const std::string& why) {
  row.simulated = true;
  row.asked = false;
  world_.set_steps_elsewhere(row.partner->robot(), false);
  row.partner->end(true, "the hub simulates the robot from here on: " + why);
  options_.log.warning("robot '" + row.name + "' is simulated from tick " + std::to_string(world_.tick()) +
                       " on: " + why);
}

// --- a tick ---

void LockstepRun::latch(core::World&) {}

void LockstepRun::after_sense(core::World& world) {
  const core::Space& space = world.space();
  const hal::TimeNs at_ns = now();
  for (Row& row : rows_) {
    row.asked = false;
    if (row.gone || row.simulated) continue;
    const core::RobotId robot = row.partner->robot();
    if (!space.contains(robot)) {
      row.gone = true;
      row.partner->end(false, "robot '" + row.name + "' was removed from the run");
    } else if (!space.halted(robot)) {
      row.partner->ask(world, at_ns);
      row.asked = true;
    }
  }
}

bool LockstepRun::after_control(core::World& world) {
  const auto waiting = [](const Row& row) { return row.asked && !row.partner->answered(); };
  const std::string at = " at tick " + std::to_string(world.tick());
  const Waited waited = wait_for(("waiting" + at).c_str(), waiting);
  if (waited == Waited::Stopped) return false;
  if (waited == Waited::TimedOut && !world.scenario().lockstep.simulate_missing) {
    world.fail("peers did not answer" + at + " within " +
               seconds(static_cast<hal::TimeNs>(world.scenario().lockstep.timeout_s * 1e9)) + ": robot " +
               missing(waiting));
    return false;
  }
  for (Row& row : rows_) {
    if (!row.asked) continue;
    if (!row.partner->answered()) {
      simulate(row, "its peer did not answer (" + row.partner->trouble() + ")");
      continue;
    }
    if (const hal::Status written = row.partner->write_commands(world); !written.ok()) {
      world.fail("peer of robot '" + row.name + "'" + at + ": " + written.error().message);
      return false;
    }
  }
  return true;
}

void LockstepRun::finish(bool failed, const std::string& why) {
  if (std::exchange(over_, true)) return;
  for (Row& row : rows_) {
    if (!row.gone && !row.simulated) row.partner->end(failed, why);
  }
}

LockstepReport LockstepRun::report() const {
  LockstepReport report{{}, strangers_, waits_, waited_ns_};
  for (const Row& row : rows_) {
    report.peers.push_back(row.partner->report());
    report.peers.back().ready = row.partner->ready() && !row.simulated && !row.gone;
    if (row.simulated) report.peers.back().state = "simulated";
    if (row.gone) report.peers.back().state = "removed";
  }
  return report;
}

}  // namespace tandem::mixed_reality
