#include "app/live/command_log.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "hal/json/json_access.hpp"

namespace tandem::app {
namespace {

using hal::Json;

/// What changes nothing.
constexpr std::array<std::string_view, 6> kQuestions = {"status",  "preflight", "history",
                                                        "inspect", "controls",  "source_files"};

using hal::text_of;

bool is_question(const Json& command) {
  return std::find(kQuestions.begin(), kQuestions.end(), text_of(command, "do")) != kQuestions.end();
}

/// The arguments, as they were said; files by their names alone.
std::string arguments_of(const Json& command) {
  std::string text;
  for (const auto& [name, value] : command.items()) {
    if (name == "do" || name == "who" || name == "by" || name == "id") continue;
    if (name == "robot" && value.is_string()) {
      text = " " + value.get<std::string>() + text;
      continue;
    }
    text += " " + name + "=" + (name == "files" ? std::string("…") : hal::to_text(value));
  }
  return text;
}

}  // namespace

std::string command_text(hal::Tick tick, const Json& command, const Json& answer) {
  const Json& from = hal::object_of(command, "by");
  const std::string who = text_of(command, "who");
  std::string text =
      fmt::format("tick {}: '{}' ({}, {}): {}{}", tick, who.empty() ? "somebody" : who, text_of(from, "role"),
                  text_of(from, "address"), text_of(command, "do"), arguments_of(command));
  const auto ok = answer.find("ok");
  if (ok != answer.end() && *ok == false) text += ": refused: " + text_of(answer, "error");
  return text;
}

void CommandLog::note(const Json& command, const Json& answer) const {
  if (!is_question(command)) keep_("command at " + command_text(live_.state().tick, command, answer));
}

core::LiveReply CommandLog::noting(const Json& command, core::LiveReply reply) const {
  if (is_question(command)) return reply;
  return [log = *this, command, reply = std::move(reply)](const Json& answer) {
    log.note(command, answer);
    if (reply) reply(answer);
  };
}

}  // namespace tandem::app
