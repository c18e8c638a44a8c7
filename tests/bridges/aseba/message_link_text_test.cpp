#include "bridges/aseba/message_link_text.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace tandem::bridges::aseba {
namespace {

using testing::HasSubstr;

std::string error_of(std::string_view text) {
  const auto opener = message_link_opener(text);
  return opener.ok() ? "accepted" : opener.error().message;
}

/// A port on this machine that listens, and does nothing else.
struct Listener {
  Listener() : socket(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return;
    ::listen(socket, 1);
    socklen_t size = sizeof address;
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~Listener() { stop(); }
  void stop() {
    if (socket >= 0) ::close(socket);
    socket = -1;
  }
  int accept() const { return ::accept(socket, nullptr, nullptr); }
  int socket;
  std::uint16_t port = 0;
};

TEST(MessageLinkText, TakesEveryLinkThatCarriesMessages) {
  for (const char* text : {"tcp:robot", "tcp:robot:33334", "tcp:[::1]", "tcp:[::1]:5", "serial:/dev/ttymxc4@921600",
                           "can:can0", "slcan:/dev/ttyACM0"}) {
    EXPECT_EQ(error_of(text), "accepted") << text;
  }
}

TEST(MessageLinkText, SaysWhatIsWrong) {
  EXPECT_THAT(error_of("tcp:"), HasSubstr("no host"));
  EXPECT_THAT(error_of("tcp::33333"), HasSubstr("no host"));
  EXPECT_THAT(error_of("tcp:robot:0"), HasSubstr("'0' is not a port"));
  EXPECT_THAT(error_of("tcp:robot:70000"), HasSubstr("not a port"));
  EXPECT_THAT(error_of("tcp:robot:x"), HasSubstr("not a port"));
  EXPECT_THAT(error_of("tcp:robot:"), HasSubstr("not a port"));
  EXPECT_THAT(error_of("tcp:[::1"), HasSubstr("never closed"));
  EXPECT_THAT(error_of("tcp:[::1]5"), HasSubstr(":PORT"));
  EXPECT_THAT(error_of("usb:x"), HasSubstr("tcp:ROBOT:33333"));
  EXPECT_THAT(error_of("lcm:udpm://239.255.76.67:7667?ttl=0"), HasSubstr("can:INTERFACE"));
}

TEST(MessagesOverTcp, PassBothWays) {
  const Listener listener;
  const auto opener = message_link_opener("tcp:127.0.0.1:" + std::to_string(listener.port));
  ASSERT_TRUE(opener.ok());
  const auto link = opener.value()();
  ASSERT_TRUE(link.ok()) << link.error().message;
  const int peer = listener.accept();
  const std::array<std::uint8_t, 2> five = {5, 0};
  EXPECT_TRUE(link.value()->send(0xA011, five));
  std::array<std::uint8_t, 8> got{};
  EXPECT_EQ(::recv(peer, got.data(), got.size(), MSG_WAITALL), 8);
  EXPECT_EQ(got, (std::array<std::uint8_t, 8>{2, 0, 0, 0, 0x11, 0xA0, 5, 0}));
  const std::array<std::uint8_t, 8> answer = {2, 0, 1, 0, 0x0C, 0x90, 5, 0};
  EXPECT_EQ(::send(peer, answer.data(), answer.size(), 0), 8);
  MessageView view;
  while (!link.value()->receive(view)) ASSERT_TRUE(link.value()->wait(5 * hal::kNsPerSecond));
  EXPECT_EQ(view.source, 1);
  EXPECT_EQ(view.type, 0x900C);
  ::close(peer);
  while (link.value()->state() == Carrier::Up) {
    ASSERT_TRUE(link.value()->wait(5 * hal::kNsPerSecond));
    link.value()->receive(view);
  }
  EXPECT_EQ(link.value()->state(), Carrier::Gone);
}

TEST(MessagesOverTcp, SayWhatToDoWhereNobodyListens) {
  Listener listener;
  listener.stop();
  const auto link = message_link_opener("tcp:127.0.0.1:" + std::to_string(listener.port)).value()();
  ASSERT_FALSE(link.ok());
  EXPECT_THAT(link.error().message, HasSubstr("is asebaswitch running"));
}

}  // namespace
}  // namespace tandem::bridges::aseba
