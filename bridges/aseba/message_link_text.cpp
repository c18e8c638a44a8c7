#include "bridges/aseba/message_link_text.hpp"

#include <charconv>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/aseba/stream_messages.hpp"
#include "bridges/aseba/tcp_link.hpp"
#include "bridges/can/can_link_opener.hpp"
#include "bridges/link/link_text.hpp"
#include "bridges/link/permitted_link.hpp"

namespace tandem::bridges::aseba {
namespace {

constexpr std::string_view kTcp = "tcp:";

struct Endpoint {
  std::string host;
  std::uint16_t port = kAsebaPort;
};

/// "host", "host:port", "[address]", "[address]:port".
hal::Result<Endpoint> parse_endpoint(std::string_view text) {
  const std::string whole = "link 'tcp:" + std::string(text) + "': ";
  Endpoint endpoint;
  std::string_view port;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return hal::Error{whole + "the [ is never closed"};
    endpoint.host = text.substr(1, end - 1);
    port = text.substr(end + 1);
    if (!port.empty() && !port.starts_with(':')) return hal::Error{whole + "after the ] comes :PORT"};
  } else {
    const std::size_t colon = text.find(':');
    endpoint.host = text.substr(0, colon);
    port = colon == std::string_view::npos ? std::string_view{} : text.substr(colon);
  }
  if (endpoint.host.empty()) return hal::Error{whole + "no host; write for example tcp:192.168.1.20:33333"};
  if (port.empty()) return endpoint;
  port.remove_prefix(1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (error != std::errc{} || end != port.data() + port.size() || endpoint.port == 0) {
    return hal::Error{whole + "'" + std::string(port) + "' is not a port; write a number from 1 to 65535"};
  }
  return endpoint;
}

hal::Result<std::unique_ptr<MessageLink>> over_bytes(hal::Result<std::unique_ptr<ByteLink>> link) {
  if (!link) return link.error();
  return std::unique_ptr<MessageLink>(std::make_unique<StreamMessages>(std::move(link).value()));
}

}  // namespace

hal::Result<MessageLinkOpener> message_link_opener(std::string_view text, const LinkTerms& terms) {
  if (text.starts_with(kTcp)) {
    const auto endpoint = parse_endpoint(text.substr(kTcp.size()));
    if (!endpoint) return endpoint.error();
    const auto connect = permitted([e = endpoint.value()] { return TcpLink::connect(e.host, e.port); }, terms.permit);
    return MessageLinkOpener([connect] { return over_bytes(connect()); });
  }
  const auto address = parse_link(text);
  if (!address) return hal::Error{address.error().message + ", tcp:ROBOT:33333"};
  if (address.value().scheme == LinkScheme::Serial) {
    const auto opener = byte_link_opener(address.value(), terms);
    if (!opener) return opener.error();
    return MessageLinkOpener([open = opener.value()] { return over_bytes(open()); });
  }
  const auto opener = can_link_opener(address.value(), aseba_filters(), terms);
  if (!opener) {
    return hal::Error{"link '" + std::string(text) +
                      "' does not carry a foot-bot's messages; use tcp:ROBOT:33333, serial:DEVICE@921600, "
                      "can:INTERFACE or slcan:DEVICE@1000000"};
  }
  return MessageLinkOpener([open = opener.value()]() -> hal::Result<std::unique_ptr<MessageLink>> {
    auto link = open();
    if (!link) return link.error();
    return std::unique_ptr<MessageLink>(std::make_unique<CanMessages>(std::move(link).value()));
  });
}

}  // namespace tandem::bridges::aseba
