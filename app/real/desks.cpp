#include "app/real/desks.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/process/terminal.hpp"
#include "app/real/desk_keys.hpp"
#include "app/real/real_robots.hpp"
#include "hal/json/json_access.hpp"
#include "mixed_reality/time/monotonic.hpp"
#include "window/wire/viewer_text.hpp"

namespace tandem::app {
namespace {

using hal::Json;
using mixed_reality::DeskWord;

constexpr const char* kSaidAt = "said_at_ns";  // of commands whose time decides

hal::TimeNs now_ns() {
  return mixed_reality::MonotonicTime().now_ns();
}

DeskWord word_of(const Json& command) {
  DeskWord word;
  word.command = hal::text_of(command, "do");
  word.robot = hal::text_of(command, "robot", "*");
  word.who = hal::text_of(command, "who");
  word.at_ns = hal::whole_of(command, kSaidAt, now_ns());
  return word;
}

/// A name as people may be shown it.
std::string name_of(const Json& command, std::string_view from) {
  std::string who = printable(hal::text_of(command, "who", from));
  if (who.size() > bridges::desk::kLongestWho) who.resize(bridges::desk::kLongestWho);
  return who.empty() ? std::string(from) : who;
}

bool is_one_of(const std::string& name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Json json_of(const DeskWord& word, hal::TimeNs at_ns) {
  return {{"do", word.command},
          {"robot", word.robot},
          {"who", word.who},
          {"age_s", std::max(0.0, hal::to_seconds(at_ns - word.at_ns))}};
}

Json answer_of(const mixed_reality::PreflightRows& rows) {
  return {{"preflight", to_json(rows)}, {"worst", mixed_reality::name_of(worst_of(rows))}};
}

}  // namespace

Json to_json(const mixed_reality::PreflightRows& rows) {
  Json all = Json::array();
  for (const mixed_reality::PreflightRow& row : rows) {
    all.push_back({{"about", row.about},
                   {"check", row.check},
                   {"finding", mixed_reality::name_of(row.finding)},
                   {"found", row.found},
                   {"advice", row.advice}});
  }
  return all;
}

Desks::Desks(core::LiveRun& live, mixed_reality::MixedSession& session, const CommandLog& commands,
             const std::atomic<bool>& stop)
    : live_(live), session_(session), commands_(commands), stop_(stop) {
  for (const char* name : {"arm", "rearm", "replace", "first_motion"})
    live.add_command(name, [this](const Json& command) { return carry_out(command); });
  live.add_command("preflight", [this](const Json&) -> hal::Result<Json> {
    auto rows = mixed_reality::look_over(session_);
    const auto machine = mixed_reality::look_over_machine(session_.world().scenario(), session_.woke_late());
    rows.insert(rows.end(), machine.begin(), machine.end());
    return answer_of(rows);
  });
  live.add_command("status", [this](const Json&) -> hal::Result<Json> {
    Json answer = real_message();
    answer.erase("type");
    answer.update(core::to_json(live_.state()));
    return answer;
  });
}

Desks::~Desks() {
  lcm_.reset();  // its thread posts
}

hal::Status Desks::listen(const core::DeskConfig& config, const std::string& keys_file) {
  if (config.lcm.empty()) return {};
  auto keys = keys_to_listen(keys_file, config.lcm, config.channel);
  if (!keys.ok()) return hal::Error{"<desk lcm=…>: " + keys.error().message};
  auto opened = bridges::desk::LcmDesk::open(
      config.lcm, config.channel, std::move(keys).value(),
      [this](const bridges::desk::DeskMessage& message, hal::UserRole role, bridges::desk::LcmDesk::Reply reply) {
        const core::LiveReply answer = [reply](const Json& json) { reply(hal::to_text(json)); };
        auto command = window::read_viewer_text(message.text);
        if (!command.ok()) return answer({{"ok", false}, {"error", "no command: " + command.error().message}});
        Json whole = std::move(command.value().whole);
        whole["who"] = message.who;
        whole["by"] = {{"role", name_of(role)}, {"address", "lcm"}};
        if (window::may_say(role, command.value().name)) return post(std::move(whole), answer, "lcm");
        const Json refused = {{"ok", false},
                              {"error", "'" + message.who + "' is a viewer, who may stop all real robots (estop); '" +
                                            command.value().name + "' needs an operator"}};
        commands_.note(whole, refused);
        answer(refused);
      });
  if (!opened.ok()) return hal::Error{"<desk lcm=…>: " + opened.error().message};
  lcm_ = std::move(opened).value();
  return {};
}

void Desks::post(Json command, core::LiveReply reply, std::string_view from) {
  const std::string name = hal::text_of(command, "do");
  command["who"] = name_of(command, from);
  command.erase(kSaidAt);
  reply = commands_.noting(command, std::move(reply));
  if (name == "estop") {
    session_.emergency_stop();
    desk_.note_stop(word_of(command));
    if (reply) reply({{"ok", true}});
    return live_.post_own(
        [weak = std::weak_ptr(note_), action = Json{{"do", "estop"}, {"who", command["who"]}, {"by", command["by"]}}] {
          if (const auto note = weak.lock()) (*note)(action);
        });
  }
  if (is_one_of(name, {"arm", "rearm", "replace", "first_motion"})) {
    command[kSaidAt] = now_ns();
  } else if (is_one_of(name, {"play", "pause", "halt", "release"})) {
    const auto admitted = desk_.admit(word_of(command), now_ns());
    if (admitted.ok() && !admitted.value().empty()) {
      reply = [reply, note = admitted.value()](const Json& answer) {
        Json with_note = answer;
        with_note["note"] = note;
        if (reply) reply(with_note);
      };
    }
  }
  live_.post(std::move(command), std::move(reply));
}

// On the thread that steps.
hal::Result<Json> Desks::carry_out(const Json& command) {
  const auto robot = command.find("robot");
  if (robot != command.end() && !robot->is_string())
    return hal::Error{"\"robot\" is the id of a real robot, or \"*\" for all"};
  const auto admitted = desk_.admit(word_of(command), now_ns());
  if (!admitted.ok()) return admitted.error();
  const std::string name = hal::text_of(command, "do"), whom = hal::text_of(command, "robot", "*");
  Json motion;
  if (name == "first_motion") {
    auto moved = first_motion(whom);
    if (!moved.ok()) return moved.error();
    motion = std::move(moved).value();
  } else if (const hal::Status done = obey(command, whom); !done.ok()) {
    return done.error();
  }
  if (note_) {
    Json action = command;
    action.erase(kSaidAt);
    action.erase("id");
    (*note_)(action);
  }
  Json answer = real_message();
  answer.erase("type");  // the answer has one of its own
  if (!motion.is_null()) answer.update(motion);
  if (!admitted.value().empty()) answer["note"] = admitted.value();
  return answer;
}

hal::Status Desks::obey(const Json& command, const std::string& robot) {
  const std::string name = hal::text_of(command, "do");
  if (name == "arm") return session_.arm(robot);
  if (name == "rearm") return session_.rearm(robot);
  return replace(command, robot);
}

/// The verdict, as preflight has it.
hal::Result<Json> Desks::first_motion(const std::string& robot) {
  const auto all = session_.status();
  const auto found = std::ranges::find(all, robot, &mixed_reality::RealRobotStatus::id);
  if (found == all.end()) return hal::Error{"first motion is of one real robot at a time: name it"};
  if (!session_.paused() || session_.world().tick() > 0)
    return hal::Error{"the run has begun: first motion is tried before, while it is held (--hold)"};
  if (session_.world().space().kind(found->robot).drive() == nullptr)
    return hal::Error{"robot '" + robot + "' has no wheels to turn on"};
  const mixed_reality::PreflightRows rows = mixed_reality::try_motion(session_, robot, stop_);
  if (keep_motion_ && !stop_.load()) keep_motion_(rows);
  return answer_of(rows);
}

hal::Status Desks::replace(const Json& command, const std::string& robot) {
  const auto& spares = session_.world().scenario().desk.spares;
  const std::string spare = hal::text_of(command, "spare"), link = hal::text_of(command, "link");
  mixed_reality::Replacement by;
  if (!spare.empty()) {
    const auto found = std::find_if(spares.begin(), spares.end(), [&](const auto& s) { return s.id == spare; });
    if (found == spares.end()) {
      std::string ids;
      for (const core::SpareItem& s : spares) ids += (ids.empty() ? "" : ", ") + s.id;
      return hal::Error{"there is no <spare id=\"" + spare + "\">; there are: " + (ids.empty() ? "none" : ids)};
    }
    by = {found->id, found->link, found->names, {}};
  } else if (!link.empty()) {
    by = {hal::text_of(command, "as", link), link, {}, {}};
    if (const std::string seen = hal::text_of(command, "seen_as"); !seen.empty()) by.names = {seen};
  } else {
    return hal::Error{"say which robot comes instead: \"spare\", an id of the file's, or \"link\""};
  }
  const auto number = [&](const char* key) -> std::optional<double> {
    const auto found = command.find(key);
    if (found == command.end() || !found->is_number() || !std::isfinite(found->get<double>())) return {};
    return found->get<double>();
  };
  if (const auto x = number("x"), y = number("y"); x && y)
    by.pose = core::Pose::at(*x, *y, number("heading").value_or(0.0));
  return session_.replace(robot, by);
}

Json Desks::real_message() const {
  Json message = app::real_message(session_.status(), session_.roll_call());
  Json spares = Json::array();
  std::set<std::string> in_use;
  for (const Json& robot : message["robots"]) in_use.insert({robot.value("device", ""), robot.value("coming", "")});
  for (const core::SpareItem& spare : session_.world().scenario().desk.spares)
    spares.push_back({{"id", spare.id}, {"link", spare.link}, {"used", in_use.contains(spare.id)}});
  message["spares"] = std::move(spares);
  const mixed_reality::DeskStatus status = desk_.status();
  const hal::TimeNs at_ns = now_ns();
  message["desk"] = {{"said", Json::object()},
                     {"turned_back", status.turned_back},
                     {"refused", status.refused},
                     {"last", status.last ? json_of(*status.last, at_ns) : Json(nullptr)},
                     {"stop", status.stop ? json_of(*status.stop, at_ns) : Json(nullptr)}};
  for (const auto& [who, count] : status.said) message["desk"]["said"][who] = count;
  message["paused"] = session_.paused();
  return message;
}

}  // namespace tandem::app
