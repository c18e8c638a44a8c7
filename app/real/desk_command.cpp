// `tandem desk`: a person's word to a run that goes on, over its window or over LCM.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <unistd.h>

#include "app/command/command.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/process/terminal.hpp"
#include "app/real/desk_keys.hpp"
#include "bridges/desk/lcm_desk.hpp"
#include "hal/json/json.hpp"
#include "hal/json/json_access.hpp"
#include "window/wire/client.hpp"

namespace tandem::app {
namespace {

struct DeskOptions {
  std::string where;    ///< "http://…?token=…" of the window, or "lcm:URL#CHANNEL"
  std::string command;  ///< status, preflight, start, pause, estop, arm, rearm, move, replace, halt, release
  std::string robot;
  std::string spare, link, as, seen_as;  ///< of replace
  std::vector<double> at;                ///< of replace: x, y, heading
  std::string who;
  std::string keys;  ///< file; empty: this user's
  bool json = false;

  void describe(hal::CommandLine& line) {
    line.footer("Exit code: 0 done, 1 the run refuses, 3 it cannot be reached.");
    line.word("where", where, "The address that the run printed (http://…), or lcm:URL, lcm:URL#CHANNEL").required();
    line.word("command", command, "What to do")
        .required()
        .one_of({"status", "preflight", "start", "pause", "go", "estop", "arm", "rearm", "move", "halt", "release",
                 "replace"});
    line.word("robot", robot, "Which robot; default: all");
    line.option("--spare", spare, "Of replace: a <spare> of the file comes instead");
    line.option("--link", link, "Of replace: the robot on this link comes instead").excludes("--spare");
    line.option("--as", as, "… and is called so").excludes("--spare");
    line.option("--seen-as", seen_as, "… and trackers know it by this name or tag").excludes("--spare");
    line.option("--at", at, "… and stands at X,Y or X,Y,HEADING (m, rad), where wheels alone tell its place")
        .separated()
        .count(2, 3);
    line.option("--who", who, "Who says it; default: user@machine");
    line.option("--keys", keys, "Over LCM: the file with the keys; default: this user's").file();
    line.flag("--json", json, "The run's answer as it is");
  }
};

using hal::Json;
using namespace std::chrono_literals;
/// How long an answer may take; a first motion takes its time.
std::chrono::seconds patience_for(const Json& command) {
  return command["do"] == "first_motion" ? 30s : 10s;
}
constexpr std::string_view kLcm = "lcm:";

hal::Result<Json> parsed(const std::string& text) {
  auto answer = hal::parse_json_object(text);
  if (!answer.ok()) return hal::Error{"the answer is none: " + answer.error().message};
  return answer;
}

hal::Result<Json> ask_window(const std::string& address, Json command) {
  auto joined = window::Client::connect(address);
  if (!joined.ok()) return joined.error();
  window::Client client = std::move(joined).value();
  command["id"] = 1;
  if (const hal::Status sent = client.send(hal::to_text(command)); !sent.ok()) return sent.error();
  const auto until = std::chrono::steady_clock::now() + patience_for(command);
  while (std::chrono::steady_clock::now() < until) {
    const auto received = client.receive(200ms);
    if (!received) continue;
    if (received->kind == window::Client::Received::Kind::Close) return hal::Error{"the run has ended"};
    if (received->kind != window::Client::Received::Kind::Text) continue;
    auto message = parsed(received->bytes);
    if (message.ok() && message.value().value("type", "") == "answer") return message;
  }
  return hal::Error{"the run did not answer within " + std::to_string(patience_for(command).count()) + " s"};
}

hal::Result<Json> ask_lcm(const std::string& where, const Json& command, const std::string& who,
                          const std::string& keys) {
  const std::size_t mark = where.find('#');  // lcm:udpm://…#channel
  const std::string url = where.substr(0, mark);
  const std::string channel = mark == std::string::npos ? "tandem/desk" : where.substr(mark + 1);
  const std::int64_t number = std::chrono::steady_clock::now().time_since_epoch().count();
  const auto key = key_to_ask(keys, url, channel, who);
  if (!key.ok()) return key.error();
  auto answer = bridges::desk::ask(url, channel, key.value(), {number, who, hal::to_text(command), {}, {}},
                                   patience_for(command));
  if (!answer.ok()) return answer.error();
  return parsed(answer.value());
}

std::string own_name() {
  const char* const user = std::getenv("USER");
  char host[64] = {};
  if (::gethostname(host, sizeof host - 1) != 0) host[0] = 0;
  return (user != nullptr ? std::string(user) : std::string("somebody")) + "@" + host;
}

Json command_of(const DeskOptions& o) {
  Json command = {{"do", o.command == "start" || o.command == "go" ? "play"
                         : o.command == "move"                     ? "first_motion"
                                                                   : o.command}};
  if (!o.robot.empty()) command["robot"] = o.robot;
  if (!o.spare.empty()) command["spare"] = o.spare;
  if (!o.link.empty()) command["link"] = o.link;
  if (!o.as.empty()) command["as"] = o.as;
  if (!o.seen_as.empty()) command["seen_as"] = o.seen_as;
  if (o.at.size() >= 2) {
    command["x"] = o.at[0];
    command["y"] = o.at[1];
    if (o.at.size() > 2) command["heading"] = o.at[2];
  }
  return command;
}

std::string shown(const Json& object, const char* name) {
  return printable(hal::text_of(object, name));
}

std::string quantity(const Json& object, const char* name, double scale, const char* unit) {
  const double value = hal::number_of(object, name, NAN);
  return std::isfinite(value) ? fmt::format("{:.0f} {}", value * scale, unit) : std::string();
}

void print_answer(const Json& answer) {
  if (const auto rows = answer.find("preflight"); rows != answer.end() && rows->is_array()) {
    for (const Json& row : *rows)
      fmt::print("{:<4}  {:<18} {:<12} {}{}\n", shown(row, "finding"), shown(row, "about"), shown(row, "check"),
                 shown(row, "found"), shown(row, "advice").empty() ? "" : "\n      -> " + shown(row, "advice"));
    return;
  }
  if (const auto roll = answer.find("roll"); roll != answer.end() && roll->is_array()) {
    for (const Json& group : *roll) fmt::print("{}\n", shown(group, "text"));
  }
  if (const auto robots = answer.find("robots"); robots != answer.end() && robots->is_array()) {
    std::vector<std::pair<std::string, std::string>> table;
    for (const Json& robot : *robots) {
      std::string text = shown(robot, "state");
      const std::string device = shown(robot, "device");
      if (!device.empty() && device != shown(robot, "id")) text += "; is '" + device + "'";
      for (const std::string& more :
           {quantity(robot, "age_s", 1e3, "ms old"), quantity(robot, "round_trip_s", 1e3, "ms there and back"),
            quantity(robot, "battery", 100.0, "% battery")})
        if (!more.empty()) text += ", " + more;
      table.emplace_back(shown(robot, "id"), text);
    }
    if (answer.value("paused", false)) table.emplace_back("the run", "is paused");
    print_table(table);
  }
  if (const std::string note = shown(answer, "note"); !note.empty()) fmt::print("{}\n", note);
}

hal::Result<Json> ask(const DeskOptions& options, Json command) {
  const std::string who = options.who.empty() ? own_name() : options.who;
  command["who"] = who;
  return options.where.starts_with(kLcm) ? ask_lcm(options.where.substr(kLcm.size()), command, who, options.keys)
                                         : ask_window(options.where, command);
}

/// That the run has done the command, and how its robots are now.
void print_done(const DeskOptions& options) {
  fmt::print("{}{}: the run has done it\n", options.command, options.robot.empty() ? "" : " " + options.robot);
  const auto after = ask(options, {{"do", "status"}});
  if (after.ok() && after.value().value("ok", false)) print_answer(after.value());
}

int desk(const DeskOptions& options) {
  const auto answer = ask(options, command_of(options));
  if (!answer.ok()) return complain(kFailedRunning, "desk: " + answer.error().message);
  if (options.json) fmt::print("{}\n", hal::to_text(answer.value()));
  if (!answer.value().value("ok", false))
    return complain(kBadInput, "the run refuses: " + shown(answer.value(), "error"));
  if (options.json) return kDone;
  print_answer(answer.value());
  if (options.command != "status" && options.command != "preflight") print_done(options);
  return kDone;
}

}  // namespace

constinit const hal::CommandType desk_command = module_command<DeskOptions, desk>("desk");

}  // namespace tandem::app
