#include "bridges/eyebot/stop_body.hpp"

#include <sstream>

namespace tandem::bridges::eyebot {

std::string to_stop_body(const StopDetails& details) {
  return details.name + " " + details.hub + " " + std::to_string(details.session) + (details.land ? " 1 " : " 0 ") +
         std::to_string(details.first_seq) + "\n";
}

std::optional<StopDetails> from_stop_body(std::string_view body) {
  std::istringstream text{std::string(body)};
  StopDetails details;
  int land = 0;
  if (!(text >> details.name >> details.hub >> details.session >> land >> details.first_seq)) return std::nullopt;
  if (land < 0 || land > 1) return std::nullopt;
  details.land = land == 1;
  return details;
}

}  // namespace tandem::bridges::eyebot
