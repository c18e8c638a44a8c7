#include "bridges/eyebot/stop_body.hpp"

#include <sstream>

namespace tandem::bridges::eyebot {

std::string to_stop_body(const LastWords& words) {
  return words.name + " " + words.hub + " " + std::to_string(words.session) + (words.land ? " 1 " : " 0 ") +
         std::to_string(words.first_seq) + "\n";
}

std::optional<LastWords> from_stop_body(std::string_view body) {
  std::istringstream text{std::string(body)};
  LastWords words;
  int land = 0;
  if (!(text >> words.name >> words.hub >> words.session >> land >> words.first_seq)) return std::nullopt;
  if (land < 0 || land > 1) return std::nullopt;
  words.land = land == 1;
  return words;
}

}  // namespace tandem::bridges::eyebot
