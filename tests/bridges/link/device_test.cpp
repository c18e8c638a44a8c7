// Two names of one device are one, two devices are two.
#include "bridges/link/device.hpp"

#include <arpa/inet.h>
#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::bridges {
namespace {

/// A pseudo-terminal; `path` is its slave's.
struct Pty {
  Pty() : master(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    ::grantpt(master);
    ::unlockpt(master);
    path = ::ptsname(master);
    slave = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  }
  ~Pty() {
    ::close(slave);
    ::close(master);
  }
  int master, slave = -1;
  std::string path;
};

TEST(Device, OfASerialLinkIsTheSameByEveryNameOpenOrNot) {
  const Pty one, other;
  std::string pattern = (std::filesystem::temp_directory_path() / "device_XXXXXX").string();
  const std::filesystem::path folder = ::mkdtemp(pattern.data());
  const auto name = folder / "puck";
  std::filesystem::create_symlink(one.path, name);
  const auto device = device_of(one.slave);
  ASSERT_TRUE(device);
  EXPECT_EQ(device_at("serial:" + one.path + "@115200"), device);
  EXPECT_EQ(device_at("serial:" + name.string() + "@9600"), device);
  EXPECT_EQ(device_at("slcan:" + name.string()), device);
  EXPECT_NE(device_of(other.slave), device);
  EXPECT_EQ(device_at("serial:" + (folder / "gone").string()), std::nullopt);
  EXPECT_EQ(serial_number_of(one.slave), std::nullopt);
  std::filesystem::remove_all(folder);
}

TEST(Device, OfATcpLinkIsItsNumericAddress) {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(listener, 1), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string port = std::to_string(ntohs(address.sin_port));
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(::connect(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(device_of(socket), "127.0.0.1:" + port);
  EXPECT_EQ(device_at("tcp:127.0.0.1:" + port), "127.0.0.1:" + port);
  EXPECT_EQ(device_at("epuck-tcp:127.0.0.1"), "127.0.0.1:1000");
  EXPECT_EQ(device_at("tcp:[::1]:" + port), "[::1]:" + port);
  ::close(socket);
  ::close(listener);
}

TEST(Device, OfNothingIsAbsent) {
  EXPECT_EQ(device_of(-1), std::nullopt);
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
  EXPECT_EQ(device_of(pipe[0]), std::nullopt);
  ::close(pipe[0]);
  ::close(pipe[1]);
  EXPECT_EQ(device_at("can:nosuchcan"), std::nullopt);
}

}  // namespace
}  // namespace tandem::bridges
