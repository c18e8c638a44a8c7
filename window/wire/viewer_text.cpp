#include "window/wire/viewer_text.hpp"

#include <algorithm>
#include <utility>

namespace tandem::window {
namespace {

/// How deep brackets are nested, outside of texts.
int depth_of(std::string_view text) noexcept {
  int depth = 0, most = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      most = std::max(most, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return most;
}

}  // namespace

hal::Result<ViewerCommand> read_viewer_text(std::string_view text) {
  if (depth_of(text) > kMostTextDepth) return hal::Error{"it is nested too deeply"};
  auto parsed = hal::parse_json_object(text);
  if (!parsed.ok()) return parsed.error();
  ViewerCommand command;
  command.whole = std::move(parsed).value();
  const auto name = command.whole.find("do");
  if (name == command.whole.end() || !name->is_string()) return hal::Error{"it has no text \"do\""};
  command.name = name->get<std::string>();
  if (const auto id = command.whole.find("id"); id != command.whole.end()) {
    const bool good = id->is_null() || id->is_number() || (id->is_string() && id->text().size() <= kMostIdBytes);
    if (!good) return hal::Error{"its \"id\" is neither a number nor a short text"};
    command.id = *id;
    command.whole.erase("id");
  }
  return command;
}

bool may_say(UserRole role, std::string_view command) noexcept {
  return role == UserRole::Operator || command == "estop" || command == "status";
}

hal::Result<std::vector<std::string>> text_list(const hal::Json& object, const char* name) {
  std::vector<std::string> texts;
  const auto found = object.find(name);
  if (found == object.end()) return texts;
  const auto wrong = [&] { return hal::Error{"\"" + std::string(name) + "\" is no list of texts"}; };
  if (!found->is_array()) return wrong();
  for (const hal::Json& text : *found) {
    if (!text.is_string()) return wrong();
    texts.push_back(text.get<std::string>());
  }
  return texts;
}

}  // namespace tandem::window
