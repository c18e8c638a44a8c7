#include "bridges/aseba/message_link_text.hpp"

#include "bridges/aseba/can_messages.hpp"
#include "bridges/aseba/stream_messages.hpp"
#include "bridges/can/can_link_opener.hpp"
#include "bridges/link/link_text.hpp"
#include "bridges/link/permitted_link.hpp"
#include "bridges/link/tcp_link.hpp"

namespace tandem::bridges::aseba {
namespace {

constexpr std::string_view kTcp = "tcp:";

hal::Result<std::unique_ptr<MessageLink>> over_bytes(hal::Result<std::unique_ptr<ByteLink>> link) {
  if (!link) return link.error();
  return std::unique_ptr<MessageLink>(std::make_unique<StreamMessages>(std::move(link).value()));
}

}  // namespace

hal::Result<MessageLinkOpener> message_link_opener(std::string_view text, const LinkTerms& terms) {
  if (text.starts_with(kTcp)) {
    const auto endpoint = parse_endpoint("tcp", text.substr(kTcp.size()), kAsebaPort);
    if (!endpoint) return endpoint.error();
    const auto connect =
        permitted([e = endpoint.value()] { return TcpLink::connect(e, "tcp", "is asebaswitch running on the robot?"); },
                  terms.permit);
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
                      "' does not carry ASEBA's messages; use tcp:ROBOT:33333, serial:DEVICE@RATE, "
                      "can:INTERFACE or slcan:DEVICE@1000000"};
  }
  return MessageLinkOpener([open = opener.value()]() -> hal::Result<std::unique_ptr<MessageLink>> {
    auto link = open();
    if (!link) return link.error();
    return std::unique_ptr<MessageLink>(std::make_unique<CanMessages>(std::move(link).value()));
  });
}

}  // namespace tandem::bridges::aseba
