// Real SocketCAN sockets on virtual interfaces, with can-utils and python-can on the other side. Runs in the guest that
// in_guest.sh makes.
#include <atomic>
#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <thread>
#include <vector>

#include "bridges/can/can_link_opener.hpp"
#include "bridges/can/slcan_link.hpp"
#include "bridges/can/socketcan_link.hpp"
#include "bridges/link/serial_link.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/can/guest_process.hpp"

namespace tandem::bridges {
namespace {

using testing::HasSubstr;

std::unique_ptr<CanLink> open_link(const std::string& interface, const std::vector<CanFilter>& filters = {}) {
  auto link = SocketCanLink::open(interface, filters);
  EXPECT_TRUE(link.ok()) << link.error().message;
  return link.ok() ? std::move(link).value() : nullptr;
}

/// What arrives within some seconds, up to `count` frames.
std::vector<CanFrame> receive(CanLink& link, std::size_t count) {
  std::vector<CanFrame> frames;
  const hal::TimeNs end = monotonic_ns() + 20 * hal::kNsPerSecond;
  CanFrame frame;
  while (frames.size() < count && monotonic_ns() < end) {
    if (link.receive(frame)) {
      frames.push_back(frame);
    } else {
      link.wait(100 * hal::kNsPerMs);
    }
  }
  return frames;
}

TEST(SocketCanLink, ReceivesWhatCansendSends) {
  const auto link = open_link("vcan0");
  const hal::TimeNs before = monotonic_ns();
  EXPECT_EQ(shell("cansend vcan0 300#11A00500; cansend vcan0 12ABCDEF#AA55; cansend vcan0 123#R"), "");
  const auto frames = receive(*link, 3);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(same_on_wire(frames[0], make_frame(0x300, std::array<std::uint8_t, 4>{0x11, 0xA0, 5, 0})));
  EXPECT_TRUE(frames[1].extended);
  EXPECT_EQ(frames[1].id, 0x12ABCDEFU);
  EXPECT_TRUE(frames[2].remote);
  EXPECT_EQ(frames[2].id, 0x123U);
  for (const CanFrame& f : frames) {
    EXPECT_GE(f.at_ns, before);
    EXPECT_LE(f.at_ns, monotonic_ns());
  }
}

TEST(SocketCanLink, SendsWhatCandumpSees) {
  const auto link = open_link("vcan0");
  Background candump("stdbuf -oL candump -L vcan0");
  const auto send = [&] {
    EXPECT_EQ(link->send(make_frame(0x300, std::array<std::uint8_t, 4>{0x11, 0xA0, 5, 0})), Sent::Taken);
  };
  EXPECT_TRUE(candump.says_after(send, "vcan0 300#11A00500")) << candump.output();
  CanFrame extended = make_frame(0x12ABCDEF, std::array<std::uint8_t, 1>{7});
  extended.extended = true;
  EXPECT_EQ(link->send(extended), Sent::Taken);
  EXPECT_TRUE(candump.says("vcan0 12ABCDEF#07")) << candump.output();
  CanFrame own;
  EXPECT_FALSE(link->receive(own));
}

TEST(SocketCanLink, LetsOnlyFilteredFramesPass) {
  const auto link = open_link("vcan0", {{0x000, 0x400, false}});
  EXPECT_EQ(shell("cansend vcan0 400#01; cansend vcan0 7FF#02; cansend vcan0 00000300#03; cansend vcan0 300#R; "
                  "cansend vcan0 301#04; cansend vcan0 0FF#05"),
            "");
  const auto frames = receive(*link, 2);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].data[0], 4);
  EXPECT_EQ(frames[1].data[0], 5);
  CanFrame none;
  EXPECT_FALSE(link->receive(none));
}

TEST(SocketCanLink, KeepsTheOrderToAndFromPythonCan) {
  const auto link = open_link("vcan0");
  // Sends back each frame with its identifier plus 1.
  Background echo(
      "python3 -u -c \"import can\nbus = can.interface.Bus('vcan0', bustype='socketcan')\nprint('listening')\n"
      "for m in bus:\n bus.send(can.Message(arbitration_id=m.arbitration_id + 1, is_extended_id=False, "
      "data=m.data))\"");
  ASSERT_TRUE(echo.says("listening")) << echo.output();
  for (std::uint32_t burst = 0; burst < 15; ++burst) {
    for (std::uint32_t i = 20 * burst; i < 20 * burst + 20; ++i) {
      const std::array<std::uint8_t, 2> data = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8U)};
      ASSERT_EQ(link->send(make_frame(0x100 + 7 * i % 3, data)), Sent::Taken);
    }
    const auto frames = receive(*link, 20);
    ASSERT_EQ(frames.size(), 20U) << echo.output();
    for (std::uint32_t i = 20 * burst; i < 20 * burst + 20; ++i) {
      const CanFrame& frame = frames[i - 20 * burst];
      EXPECT_EQ(frame.id, 0x101 + 7 * i % 3);
      EXPECT_EQ(frame.data[0] | frame.data[1] << 8U, i);
    }
  }
}

TEST(SocketCanLink, TakesOverWhatErrorFramesSay) {
  const auto link = open_link("vcan0");
  CanFrame frame;
  const auto becomes = [&](BusState state) {
    for (int i = 0; i < 200 && link->state() != state; ++i) {
      link->wait(10 * hal::kNsPerMs);
      link->receive(frame);
    }
    return link->state() == state;
  };
  EXPECT_EQ(shell("cansend vcan0 20000004#0020000000000000"), "");
  EXPECT_TRUE(becomes(BusState::Passive));
  EXPECT_EQ(shell("cansend vcan0 20000040#0000000000000000"), "");
  EXPECT_TRUE(becomes(BusState::BusOff));
  EXPECT_EQ(link->send(make_frame(1, {})), Sent::Refused);
  EXPECT_EQ(shell("cansend vcan0 20000100#0000000000000000"), "");
  EXPECT_TRUE(becomes(BusState::Active));
  EXPECT_EQ(link->send(make_frame(1, {})), Sent::Taken);
  EXPECT_EQ(link->statistics().bus_offs, 1U);
  EXPECT_EQ(link->statistics().restarts, 1U);
  EXPECT_EQ(link->statistics().error_reports, 3U);
}

TEST(SocketCanLink, GoesDownAndUpWithItsInterface) {
  const auto link = open_link("vcan1");
  CanFrame frame;
  EXPECT_EQ(shell("ip link set vcan1 down"), "");
  link->wait(hal::kNsPerSecond);
  EXPECT_FALSE(link->receive(frame));
  EXPECT_EQ(link->state(), BusState::Down);
  EXPECT_EQ(link->send(make_frame(1, {})), Sent::Refused);
  EXPECT_THAT(SocketCanLink::open("vcan1").error().message, HasSubstr("ip link set vcan1 up"));
  EXPECT_EQ(shell("ip link set vcan1 up"), "");
  link->wait(hal::kNsPerSecond);
  EXPECT_EQ(link->state(), BusState::Active);
  EXPECT_EQ(link->send(make_frame(1, {})), Sent::Taken);
  EXPECT_EQ(shell("cansend vcan1 300#01"), "");
  EXPECT_EQ(receive(*link, 1).size(), 1U);
  EXPECT_EQ(link->statistics().downs, 1U);
  EXPECT_EQ(link->statistics().restarts, 1U);
}

TEST(SocketCanLink, IsGoneWhenItsInterfaceIs) {
  EXPECT_EQ(shell("ip link add dev vcan9 type vcan && ip link set vcan9 up"), "");
  const auto link = open_link("vcan9");
  EXPECT_EQ(shell("ip link del vcan9"), "");
  CanFrame frame;
  for (int i = 0; i < 100 && link->state() != BusState::Gone; ++i) {
    link->wait(10 * hal::kNsPerMs);
    link->receive(frame);
    link->send(make_frame(1, {}));
  }
  EXPECT_EQ(link->state(), BusState::Gone);
  EXPECT_THAT(SocketCanLink::open("vcan9").error().message, HasSubstr("no such interface"));
  EXPECT_THAT(SocketCanLink::open("an interface's name that is too long").error().message,
              HasSubstr("no such interface"));
}

TEST(SocketCanLink, CountsFramesThatTheKernelDropped) {
  const auto link = open_link("vcan0");
  constexpr std::uint64_t kFlood = 20000;
  EXPECT_EQ(shell("cangen vcan0 -g 0 -I 100 -L 8 -n " + std::to_string(kFlood)), "");
  EXPECT_EQ(shell("sleep 0.2; cansend vcan0 301#01"), "");
  CanFrame frame;
  while (link->receive(frame)) {
  }
  // The kernel tells the count with the next frame that it delivers.
  EXPECT_EQ(shell("cansend vcan0 302#01"), "");
  ASSERT_EQ(receive(*link, 1).size(), 1U);
  const CanStatistics s = link->statistics();
  EXPECT_EQ(s.frames_in + s.overrun, kFlood + 2);
  EXPECT_GT(s.overrun, 0U);
}

/// A serial line in memory: what one end writes is read at the other. The kernel's slcan driver sits on one end.
struct PtyPair {
  PtyPair() {
    for (std::size_t i = 0; i < 2; ++i) {
      std::array<char, 128> name{};
      termios raw{};
      cfmakeraw(&raw);
      if (openpty(&masters[i], &slaves[i], name.data(), &raw, nullptr) != 0) ADD_FAILURE() << "no pseudo-terminal";
      paths[i] = name.data();
    }
  }
  ~PtyPair() {
    stop();
    for (std::size_t i = 0; i < 2; ++i) {
      close(masters[i]);
      close(slaves[i]);
    }
  }
  void join() {
    thread = std::thread([this] {
      std::array<char, 4096> buffer{};
      while (!ending) {
        std::array<pollfd, 2> p = {{{masters[0], POLLIN, 0}, {masters[1], POLLIN, 0}}};
        ::poll(p.data(), p.size(), 10);
        for (std::size_t i = 0; i < 2; ++i) {
          if ((p[i].revents & POLLIN) == 0) continue;
          const ssize_t n = ::read(masters[i], buffer.data(), buffer.size());
          if (n > 0 && ::write(masters[1 - i], buffer.data(), static_cast<std::size_t>(n)) != n) ADD_FAILURE();
        }
      }
    });
  }
  void stop() {
    ending = true;
    if (thread.joinable()) thread.join();
  }
  std::array<int, 2> masters{};
  std::array<int, 2> slaves{};
  std::array<std::string, 2> paths;
  std::atomic<bool> ending{false};
  std::thread thread;
};

/// Puts the kernel's driver on the first end. Returns the name of its interface.
std::string attach(const PtyPair& line) {
  const std::string said = shell("slcan_attach " + line.paths[0]);
  const std::string before = "attached tty " + line.paths[0] + " to netdevice ";
  EXPECT_THAT(said, testing::StartsWith(before));
  return said.size() < before.size() + 2 ? "" : said.substr(before.size(), said.find('\n') - before.size());
}

TEST(SlcanLink, UnderstandsTheKernelsOwnSlcanDriver) {
  PtyPair line;
  line.join();
  const std::string interface = attach(line);
  EXPECT_EQ(shell("ip link set " + interface + " up"), "");
  auto serial = SerialLink::open({LinkScheme::Serial, line.paths[1], 3'000'000});
  ASSERT_TRUE(serial.ok()) << serial.error().message;
  auto near = SlcanLink::open(std::move(serial).value(), {.answer_ns = 20 * hal::kNsPerMs, .flags_ns = 0});
  ASSERT_TRUE(near.ok()) << near.error().message;
  const auto far = open_link(interface);
  ASSERT_NE(far, nullptr);
  std::vector<CanFrame> sent;
  for (std::uint32_t i = 0; i < 40; ++i) {
    CanFrame frame = make_frame(i % 4 == 0 ? 0x100000 + i : 0x300 + i,
                                std::vector<std::uint8_t>(i % 9, static_cast<std::uint8_t>(i)));
    frame.extended = i % 4 == 0;
    sent.push_back(frame);
  }
  for (CanLink* from : {far.get(), near.value().get()}) {
    CanLink* to = from == far.get() ? near.value().get() : far.get();
    for (const CanFrame& frame : sent) {
      Sent taken = from->send(frame);
      for (int i = 0; i < 1000 && taken == Sent::Full; ++i) {
        ::usleep(1000);
        taken = from->send(frame);
      }
      ASSERT_EQ(taken, Sent::Taken);
    }
    const auto got = receive(*to, sent.size());
    ASSERT_EQ(got.size(), sent.size());
    for (std::size_t i = 0; i < got.size(); ++i) EXPECT_TRUE(same_on_wire(got[i], sent[i])) << i;
    EXPECT_EQ(to->statistics().malformed, 0U);
  }
  near.value().reset();
  EXPECT_EQ(shell("slcan_attach -d " + line.paths[0]), "");
}

TEST(SocketCanLink, FindsNoRoomWhereNothingLeavesTheInterface) {
  PtyPair line;  // nobody reads the far end
  const std::string interface = attach(line);
  EXPECT_EQ(shell("ip link set " + interface + " txqueuelen 5 up"), "");
  const auto link = open_link(interface);
  ASSERT_NE(link, nullptr);
  Sent sent = Sent::Taken;
  for (int i = 0; i < 10000 && sent == Sent::Taken; ++i) {
    sent = link->send(make_frame(0x123, std::array<std::uint8_t, 8>{1, 2, 3, 4, 5, 6, 7, 8}));
  }
  EXPECT_EQ(sent, Sent::Full);
  EXPECT_EQ(link->statistics().full, 1U);
  EXPECT_EQ(link->state(), BusState::Active);
  line.join();  // now somebody reads: it goes on by itself
  for (int i = 0; i < 2000 && sent == Sent::Full; ++i) {
    ::usleep(1000);
    sent = link->send(make_frame(0x124, {}));
  }
  EXPECT_EQ(sent, Sent::Taken);
  shell("slcan_attach -d " + line.paths[0]);
}

}  // namespace
}  // namespace tandem::bridges
