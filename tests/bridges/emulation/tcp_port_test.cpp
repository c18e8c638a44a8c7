#include "bridges/emulation/tcp_port.hpp"

#include <arpa/inet.h>
#include <array>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::bridges {
namespace {

using testing::HasSubstr;

/// Connects by hand to "SCHEME:127.0.0.1:PORT".
struct Host {
  explicit Host(const std::string& path) : socket(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(path.substr(path.rfind(':') + 1))));
    connected = ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~Host() { hang_up(); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  void hang_up() {
    if (socket >= 0) ::close(socket);
    socket = -1;
  }
  void say(const std::string& text) const { static_cast<void>(!::send(socket, text.data(), text.size(), 0)); }
  int socket;
  bool connected = false;
};

/// What the port reads within ten seconds.
std::string read(TcpPort& port) {
  std::array<std::uint8_t, 16> buffer{};
  for (int i = 0; i < 1000; ++i) {
    const auto count = port.read(buffer);
    if (count.ok() && count.value() > 0) return {buffer.begin(), buffer.begin() + static_cast<long>(count.value())};
    pollfd p{port.descriptor(), POLLIN, 0};
    ::poll(&p, 1, 10);
  }
  return "";
}

TEST(TcpPort, ServesOneHostAfterTheOther) {
  auto opened = TcpPort::open("tcp-listen", "tcp", "0", 115200);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  TcpPort& port = *opened.value();
  EXPECT_THAT(port.path(), HasSubstr("tcp:127.0.0.1:"));
  Host first(port.path()), second(port.path());
  ASSERT_TRUE(first.connected && second.connected) << "the second is let in";
  first.say("one");
  EXPECT_EQ(read(port), "one");
  second.say("two");
  std::array<std::uint8_t, 16> buffer{};
  EXPECT_EQ(port.read(buffer).value(), 0U) << "and not heard";
  const std::array<std::uint8_t, 2> answer = {'o', 'k'};
  EXPECT_EQ(port.write(answer), 2U);
  first.hang_up();
  EXPECT_EQ(read(port), "two");
  EXPECT_EQ(port.hosts(), 2U);
}

TEST(TcpPort, OpensTheSamePortAgain) {
  auto opened = TcpPort::open("tcp-listen", "tcp", "0", 115200);
  ASSERT_TRUE(opened.ok());
  const std::string link = opened.value()->link(), path = opened.value()->path();
  opened.value().reset();
  const auto again = TcpPort::open("tcp-listen", "tcp", link.substr(link.find(':') + 1), 115200);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again.value()->path(), path);
}

TEST(TcpPort, SaysWhatIsWrong) {
  EXPECT_THAT(TcpPort::open("tcp-listen", "tcp", "70000", 1).error().message, HasSubstr("'70000' is no port"));
  EXPECT_THAT(TcpPort::open("tcp-listen", "tcp", "", 1).error().message, HasSubstr("write for example tcp-listen:"));
  EXPECT_THAT(TcpPort::open("tcp-listen", "tcp", "no such host.invalid:1", 1).error().message, HasSubstr("no host"));
}

}  // namespace
}  // namespace tandem::bridges
