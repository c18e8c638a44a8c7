// A run in lock-step: a simulated world that waits, in every tick, for the robots whose controllers step elsewhere.
//
//   latch -> physics -> sense | ask all peers | controllers of the hub step meanwhile | wait for every answer | limit
//
// Nothing of a peer but its commands enters the world, so a run is as deterministic as a simulation: with the same
// controllers its fingerprints are those of the pure simulation.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bridges/link/listener.hpp"
#include "bridges/peer/frame.hpp"
#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "mixed_reality/lockstep/partner.hpp"
#include "mixed_reality/lockstep/remote_peer.hpp"

namespace tandem::mixed_reality {

struct LockstepOptions {
  hal::Log log = {};
  const std::atomic<bool>* stop = nullptr;  ///< ends every wait
  hal::TimeNs (*clock)() = nullptr;         ///< of time-outs; null: CLOCK_MONOTONIC
  /// Makes the partner behind `<peer link="emulated:…">`; empty: there are none here.
  std::function<hal::Result<std::unique_ptr<Partner>>(core::World&, core::RobotId, const std::string& what)>
      make_emulated = {};
  /// The hub's copy of a robot's controller, to compare the peer's with; empty: no comparison.
  std::function<std::optional<bridges::peer::ControllerCopy>(core::World&, core::RobotId)> copy_of = {};
};

struct LockstepReport {
  std::vector<PartnerReport> peers;  ///< in the order of the experiment file
  std::uint64_t strangers = 0;       ///< connections that were refused, or were no peers
  std::uint64_t waits = 0;           ///< waits for a peer of a second and more
  hal::TimeNs waited_ns = 0;         ///< of wall time, for answers
};

/// All calls come from the thread that steps. The world must outlive this.
class LockstepRun final : public core::ExternalRobots {
 public:
  static constexpr hal::TimeNs kNameAfter_ns = 800 * hal::kNsPerMs;  ///< missing peers are named then
  static constexpr hal::TimeNs kNameAgain_ns = 10 * hal::kNsPerSecond;

  /// Listens, and takes the robots with a `<peer>` over. Errors: a link that there is not, a port that is taken.
  static hal::Result<std::unique_ptr<LockstepRun>> make(core::World& world, const LockstepOptions& options);
  ~LockstepRun() override;

  /// Where peers connect: "tcp:127.0.0.1:7654"; empty: no robot's peer comes by itself.
  std::string address() const { return listener_ == nullptr ? std::string() : listener_->path(); }

  /// Waits for every peer. Those that are missing are simulated where the file says so. Error: they are not there in
  /// time, or `stop`.
  hal::Status connect();
  /// Tells the peers that the run is over.
  void finish(bool failed, const std::string& why);
  /// Before a first tick: leaves without a word, so that the peers look for the next run.
  void let_go() noexcept { over_ = true; }
  LockstepReport report() const;

  void latch(core::World& world) override;
  void after_sense(core::World& world) override;
  bool after_control(core::World& world) override;
  void after_filter(core::World&) override {}

 private:
  struct Row {
    std::string name;
    std::unique_ptr<Partner> partner;
    RemotePeer* remote = nullptr;  // the same; null: it is emulated
    bool asked = false;            // in this tick
    bool simulated = false;        // it is missing, and its controller steps here
    bool gone = false;             // its robot is
  };
  /// A peer that has connected, and not yet named its robot.
  struct Visitor {
    std::unique_ptr<bridges::ByteLink> link;
    bridges::peer::FrameReader reader;
    hal::TimeNs since_ns = 0;
  };

  LockstepRun(core::World& world, const LockstepOptions& options);
  hal::Status add(const core::RobotItem& item, core::RobotId robot, const std::string& session);
  hal::TimeNs now() const { return options_.clock != nullptr ? options_.clock() : bridges::monotonic_ns(); }

  enum class Waited { Done, TimedOut, Stopped };
  template <class Waiting>
  Waited wait_for(const char* what, const Waiting& waiting);
  template <class Waiting>
  std::string missing(const Waiting& waiting) const;
  void look_after_links(int timeout_ms);
  void let_in();
  bool admit(Visitor& visitor);
  RemotePeer* peer_for(const bridges::peer::Hello& hello, std::string& why);
  void simulate(Row& row, const std::string& why);

  core::World& world_;
  LockstepOptions options_;
  std::unique_ptr<bridges::Listener> listener_;
  std::vector<Row> rows_;
  std::vector<Visitor> visitors_;
  std::uint64_t strangers_ = 0, waits_ = 0;
  hal::TimeNs waited_ns_ = 0;
  bool over_ = false;
};

}  // namespace tandem::mixed_reality
