#include "bridges/trackers/udp_tracker.hpp"

#include <arpa/inet.h>
#include <chrono>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "tests/bridges/trackers/bytes.hpp"

namespace tandem::bridges::trackers {
namespace {

std::vector<Sighting> take_until(Tracker& tracker, std::uint64_t messages) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (tracker.report().messages < messages && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  std::vector<Sighting> seen(100);
  seen.resize(tracker.take(seen));
  return seen;
}

TEST(UdpTracker, TakesBothFormsAndCountsWhatIsNone) {
  int port = 0;
  const hal::Log log(
      [&](hal::Severity, std::string_view text) { port = std::stoi(std::string(text.substr(text.rfind(' ') + 1))); });
  const auto options = std::make_shared<UdpOptions>();
  options->port = 0;
  auto made = make_udp_tracker({"udp", "u", "", options}, log);
  ASSERT_TRUE(made.ok());
  Tracker& tracker = *made.value();
  ASSERT_TRUE(tracker.start().ok());
  ASSERT_GT(port, 0);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  for (const Bytes& bytes : {text_bytes(R"({"id":"a","x":1,"y":2})"), compact(9, {{"b", 3.0, 4.0}}),
                             text_bytes("nonsense"), Bytes{}, text_bytes("TDP1")})
    ASSERT_GE(::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
  ::close(socket);
  const auto seen = take_until(tracker, 5);
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].who(), "a");
  EXPECT_EQ(seen[1].who(), "b");
  EXPECT_GT(seen[1].received_ns, 0);
  const TrackerReport report = tracker.report();
  EXPECT_EQ(report.messages, 5U);
  EXPECT_EQ(report.malformed, 3U);
  EXPECT_EQ(report.sightings, 2U);
}

TEST(UdpTracker, SaysWhenItsPortIsTakenOrItsAddressIsNone) {
  const auto options = std::make_shared<UdpOptions>();
  options->address = "nowhere";
  EXPECT_FALSE(check_udp_tracker({"udp", "u", "", options}).ok());
  options->address = "192.0.2.1";  // of no computer
  auto made = make_udp_tracker({"udp", "u", "", options}, {});
  ASSERT_TRUE(made.ok());
  const hal::Status started = made.value()->start();
  ASSERT_FALSE(started.ok());
  EXPECT_NE(started.error().message.find("7700"), std::string::npos);
}

}  // namespace
}  // namespace tandem::bridges::trackers
