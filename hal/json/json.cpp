#include "hal/json/json.hpp"

#include <set>
#include <vector>

namespace tandem::hal {

std::string to_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<Json> parse_json_object(std::string_view text) {
  std::vector<std::set<std::string>> names;  // of the objects that are open
  std::string twice;
  const auto note = [&](int /*depth*/, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) names.emplace_back();
    if (event == Json::parse_event_t::object_end) names.pop_back();
    if (event == Json::parse_event_t::key && !names.back().insert(value.get<std::string>()).second) twice = value;
    return true;
  };
  try {
    Json json = Json::parse(text, note);
    if (!twice.empty()) return Error{"it is no JSON object: the name \"" + twice + "\" stands twice"};
    if (!json.is_object()) return Error{"it is no JSON object, but a " + std::string(json.type_name())};
    return json;
  } catch (const Json::exception& e) {
    const std::string_view why = e.what();  // "[json.exception.parse_error.101] parse error at …"
    const std::size_t bracket = why.find("] ");
    return Error{"it is no JSON object: " +
                 std::string(bracket == std::string_view::npos ? why : why.substr(bracket + 2))};
  }
}

}  // namespace tandem::hal
