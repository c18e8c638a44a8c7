// Commands of all desks to a run with real robots: the window's, the terminal's, those over LCM.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/live/command_log.hpp"
#include "bridges/desk/lcm_desk.hpp"
#include "core/live/live_run.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/json/json.hpp"
#include "mixed_reality/desk/desk.hpp"
#include "mixed_reality/desk/preflight.hpp"
#include "mixed_reality/session/mixed_session.hpp"

namespace tandem::app {

/// [{"about", "check", "finding", "found", "advice"}]
hal::Json to_json(const mixed_reality::PreflightRows& rows);

class Desks {
 public:
  /// Adds arm, rearm, replace, preflight and first_motion to the commands of `live`. All must outlive this; `stop` ends
  /// a first motion.
  Desks(core::LiveRun& live, mixed_reality::MixedSession& session, const CommandLog& commands,
        const std::atomic<bool>& stop);
  ~Desks();
  Desks(const Desks&) = delete;
  Desks& operator=(const Desks&) = delete;

  /// Listens for commands over LCM, where the experiment says so, by those who have a key (app/real/desk_keys.hpp).
  /// Error: it cannot.
  hal::Status listen(const core::DeskConfig& config, const std::string& keys);
  /// Called by the thread that steps for what has been done and belongs into a record.
  void on_done(std::function<void(const hal::Json& action)> note) {
    note_ = std::make_shared<const Note>(std::move(note));
  }
  /// Called by the same thread for what a first motion has found.
  void on_first_motion(std::function<void(const mixed_reality::PreflightRows&)> keep) {
    keep_motion_ = std::move(keep);
  }

  /// Any command of the window's protocol; on any thread. An emergency stop waits for no tick. `from`: who says it,
  /// unless the command does in "who"; "by" in it comes from the door that let it in: {"role", "address"}.
  void post(hal::Json command, core::LiveReply reply, std::string_view from);

  /// Message "real" of the view protocol: every real robot, the spares, whose word counted. By the thread that steps.
  hal::Json real_message() const;

 private:
  hal::Result<hal::Json> carry_out(const hal::Json& command);
  hal::Status obey(const hal::Json& command, const std::string& robot);
  hal::Result<hal::Json> first_motion(const std::string& robot);
  hal::Status replace(const hal::Json& command, const std::string& robot);

  core::LiveRun& live_;
  mixed_reality::MixedSession& session_;
  const CommandLog& commands_;
  const std::atomic<bool>& stop_;
  mixed_reality::Desk desk_;
  using Note = std::function<void(const hal::Json&)>;
  std::shared_ptr<const Note> note_;  // what is posted and not yet carried out does not outlive it
  std::function<void(const mixed_reality::PreflightRows&)> keep_motion_;
  std::unique_ptr<bridges::desk::LcmDesk> lcm_;
};

}  // namespace tandem::app
