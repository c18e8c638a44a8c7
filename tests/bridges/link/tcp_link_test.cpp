#include "bridges/link/tcp_link.hpp"

#include <gmock/gmock.h>

#include "tests/bridges/link/tcp_peer.hpp"

namespace tandem::bridges {
namespace {

using testing::HasSubstr;

std::string error_of(std::string_view text, std::uint16_t usual_port = 0) {
  const auto endpoint = parse_endpoint("tcp", text, usual_port);
  return endpoint.ok() ? "accepted" : endpoint.error().message;
}

TEST(Endpoint, IsAHostAndAPort) {
  const Endpoint named = parse_endpoint("tcp", "robot:3000").value();
  EXPECT_EQ(named.host, "robot");
  EXPECT_EQ(named.port, 3000);
  const Endpoint numbered = parse_endpoint("tcp", "[fe80::1]", 1000).value();
  EXPECT_EQ(numbered.host, "fe80::1");
  EXPECT_EQ(numbered.port, 1000);
}

TEST(Endpoint, SaysWhatIsWrong) {
  EXPECT_THAT(error_of(""), HasSubstr("no host"));
  EXPECT_THAT(error_of(":3000"), HasSubstr("no host"));
  EXPECT_THAT(error_of("robot"), HasSubstr("no port; write for example tcp:robot:3000"));
  EXPECT_THAT(error_of("robot:"), HasSubstr("not a port"));
  EXPECT_THAT(error_of("robot:0"), HasSubstr("not a port"));
  EXPECT_THAT(error_of("robot:65536"), HasSubstr("not a port"));
  EXPECT_THAT(error_of("[::1:3"), HasSubstr("never closed"));
  EXPECT_THAT(error_of("[::1]3"), HasSubstr(":PORT"));
}

TEST(TcpLink, CarriesBytesBothWaysAndSeesTheOtherSideGo) {
  TcpPeer peer;
  const auto opened = TcpLink::connect({"127.0.0.1", peer.port()});
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  ByteLink& link = *opened.value();
  peer.accept();
  const std::array<std::uint8_t, 3> three = {1, 2, 3};
  EXPECT_EQ(link.write(three, hal::kNsPerSecond), 3U);
  EXPECT_EQ(peer.receive(3), (std::vector<std::uint8_t>{1, 2, 3}));
  peer.send({9, 8});
  std::array<std::uint8_t, 16> got{};
  ASSERT_TRUE(link.wait(10 * hal::kNsPerSecond));
  EXPECT_EQ(link.read(got).size, 2U);
  EXPECT_EQ(got[1], 8);
  peer.hang_up();
  ASSERT_TRUE(link.wait(10 * hal::kNsPerSecond));
  EXPECT_EQ(link.read(got).size, 0U);
  EXPECT_EQ(link.state(), LinkState::HungUp);
  EXPECT_EQ(link.write(three, 0), 0U);
  EXPECT_EQ(link.statistics().bytes_refused, 3U);
}

TEST(TcpLink, NeverWaitsLongerThanItMayForAPeerThatDoesNotRead) {
  TcpPeer peer;
  const auto opened = TcpLink::connect({"127.0.0.1", peer.port()});
  ASSERT_TRUE(opened.ok());
  peer.accept();
  const std::vector<std::uint8_t> much(1 << 16);
  std::size_t taken = 0, asked = 0;
  const hal::TimeNs begin = monotonic_ns();
  for (; asked == taken && asked < (std::size_t{1} << 26); asked += much.size())
    taken += opened.value()->write(much, hal::kNsPerMs);
  EXPECT_LT(taken, asked) << "it takes no more";
  EXPECT_LT(monotonic_ns() - begin, 20 * hal::kNsPerSecond);
  EXPECT_EQ(opened.value()->state(), LinkState::Open);
}

TEST(TcpLink, SaysWhatToDoWhereNobodyListens) {
  TcpPeer peer;
  peer.stop_listening();
  const auto link = TcpLink::connect({"127.0.0.1", peer.port()}, "tcp", "is ser2net running there?");
  ASSERT_FALSE(link.ok());
  EXPECT_THAT(link.error().message, HasSubstr("nobody listens there; is ser2net running there?"));
  const auto nowhere = TcpLink::connect({"no such host.invalid", 3000});
  ASSERT_FALSE(nowhere.ok());
  EXPECT_THAT(nowhere.error().message, HasSubstr("the host is not known here"));
}

}  // namespace
}  // namespace tandem::bridges
