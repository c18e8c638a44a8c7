// An adapter played by hand on the far side of a pseudo-terminal, which behaves as an adapter's serial port does.
#include "bridges/can/slcan_link.hpp"

#include <atomic>
#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "bridges/can/can_link_opener.hpp"
#include "bridges/link/serial_link.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges {
namespace {

using testing::HasSubstr;

constexpr SlcanSettings kQuick{.drain_ns = 2 * hal::kNsPerMs, .answer_ns = 20 * hal::kNsPerMs, .flags_ns = 0};

/// Answers commands as a CANUSB does and keeps every line; `refuse` is answered BEL.
class Adapter {
 public:
  explicit Adapter(std::string refuse = "") : refuse_(std::move(refuse)) {
    int slave = -1;
    std::array<char, 128> name{};
    if (openpty(&master_, &slave, name.data(), nullptr, nullptr) != 0) return;
    path = name.data();
    termios raw{};
    tcgetattr(slave, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave, TCSANOW, &raw);
    slave_ = slave;  // held open, so that the master never sees a hang-up
    thread_ = std::thread([this] { run(); });
  }
  ~Adapter() { unplug(); }
  void unplug() {
    if (!thread_.joinable()) return;
    ending_ = true;
    thread_.join();
    close(slave_);
    close(master_);
  }
  void say(const std::string& text) const {
    if (::write(master_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
      ADD_FAILURE() << "lost " << text;
  }
  /// Waits for a line that was received, at most some seconds.
  bool heard(const std::string& line) {
    for (int i = 0; i < 5000; ++i) {
      {
        const std::lock_guard lock(mutex_);
        if (std::ranges::find(lines_, line) != lines_.end()) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  std::vector<std::string> lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }
  std::string path;

 private:
  void run() {
    std::string line;
    while (!ending_) {
      pollfd p{master_, POLLIN, 0};
      if (::poll(&p, 1, 5) <= 0) continue;
      char c = 0;
      if (::read(master_, &c, 1) != 1) continue;
      if (c != '\r') {
        line.push_back(c);
        continue;
      }
      const std::lock_guard lock(mutex_);
      lines_.push_back(line);
      if (!refuse_.empty() && line.starts_with(refuse_)) {
        say("\a");
      } else if (line == "V") {
        say("V1013\r");
      } else if (line.starts_with('t')) {
        say("z\r");
      } else {
        say("\r");
      }
      line.clear();
    }
  }
  std::string refuse_;
  int master_ = -1;
  int slave_ = -1;
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

hal::Result<std::unique_ptr<CanLink>> open_on(const Adapter& adapter, SlcanSettings settings = {}) {
  settings.flags_ns = 0;
  auto line = SerialLink::open({LinkScheme::Serial, adapter.path, 3'000'000});
  if (!line) return line.error();
  return SlcanLink::open(std::move(line).value(), settings);
}

TEST(SlcanLink, OpensTheChannelAtTheBusesRateAndClosesItAtTheEnd) {
  Adapter adapter;
  auto link = open_on(adapter, {.strict = true});
  ASSERT_TRUE(link.ok()) << link.error().message;
  EXPECT_EQ(adapter.lines(), (std::vector<std::string>{"", "", "", "C", "V", "S8", "O"}));
  link.value().reset();
  EXPECT_TRUE(adapter.heard("C"));
}

TEST(SlcanLink, CarriesFramesBothWaysOverAPseudoTerminal) {
  Adapter adapter;
  auto opened = open_on(adapter);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  CanLink& link = *opened.value();
  EXPECT_EQ(link.send(make_frame(0x300, std::array<std::uint8_t, 4>{0x11, 0xA0, 5, 0})), Sent::Taken);
  EXPECT_TRUE(adapter.heard("t300411A00500"));
  adapter.say("t30140C900500\r");
  CanFrame frame;
  while (!link.receive(frame)) ASSERT_TRUE(link.wait(5 * hal::kNsPerSecond));
  EXPECT_TRUE(same_on_wire(frame, make_frame(0x301, std::array<std::uint8_t, 4>{0x0C, 0x90, 5, 0})));
  EXPECT_GT(frame.at_ns, 0);
  EXPECT_EQ(link.statistics().frames_out, 1U);
  EXPECT_EQ(link.statistics().frames_in, 1U);
  EXPECT_EQ(link.statistics().malformed, 0U);
}

TEST(SlcanLink, SaysWhichStepAnAdapterRefuses) {
  Adapter no_rate("S");
  EXPECT_THAT(open_on(no_rate).error().message, HasSubstr("bit rate 1000000"));
  Adapter no_open("O");
  EXPECT_THAT(open_on(no_open).error().message, HasSubstr("does not open its channel"));
  EXPECT_THAT(open_on(no_open, {.bits_per_s = 9600}).error().message, HasSubstr("no bit rate 9600"));
}

TEST(SlcanLink, IsGoneWhenTheAdapterIsPulledOut) {
  Adapter adapter;
  auto opened = open_on(adapter);
  ASSERT_TRUE(opened.ok());
  adapter.unplug();
  CanFrame frame;
  for (int i = 0; i < 100 && opened.value()->state() != BusState::Gone; ++i) {
    opened.value()->wait(50 * hal::kNsPerMs);
    opened.value()->receive(frame);
  }
  EXPECT_EQ(opened.value()->state(), BusState::Gone);
  EXPECT_EQ(opened.value()->send(make_frame(1, {})), Sent::Refused);
  EXPECT_EQ(opened.value()->statistics().downs, 1U);
}

/// Over memory: every byte is where the test puts it.
struct MemoryRig {
  explicit MemoryRig(SlcanSettings settings = kQuick, std::size_t capacity = 4096) {
    auto [near, other] = MemoryLink::make_pair(monotonic_ns, capacity);
    far = std::move(other);
    auto opened = SlcanLink::open(std::move(near), settings);
    if (opened) {
      link = std::move(opened).value();
    } else {
      error = opened.error().message;
    }
    read();
  }
  std::string read() const {
    std::array<std::uint8_t, 4096> buffer;
    const std::size_t n = far->read(buffer).size;
    std::string text(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(n));
    while (const std::size_t more = far->read(buffer).size)
      text.append(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(more));
    return text;
  }
  void say(const std::string& text) const {
    far->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, 0);
  }
  std::unique_ptr<MemoryLink> far;
  std::unique_ptr<CanLink> link;
  std::string error;
};

TEST(SlcanLink, TakesAnAdapterThatNeverAnswersUnlessToldOtherwise) {
  EXPECT_NE(MemoryRig().link, nullptr);
  SlcanSettings strict = kQuick;
  strict.strict = true;
  EXPECT_THAT(MemoryRig(strict).error, HasSubstr("does not answer"));
}

TEST(SlcanLink, CountsWhatAnAdapterSaysAboutTheBus) {
  MemoryRig rig;
  CanFrame frame;
  rig.say("sw100000\rsp130000\r");
  EXPECT_FALSE(rig.link->receive(frame));
  EXPECT_EQ(rig.link->state(), BusState::Passive);
  rig.say("sb256256\re1a\rt30\r\a");
  EXPECT_FALSE(rig.link->receive(frame));
  EXPECT_EQ(rig.link->state(), BusState::BusOff);
  EXPECT_EQ(rig.link->send(make_frame(1, {})), Sent::Refused);
  rig.say("sa000000\rt1230\r");
  EXPECT_TRUE(rig.link->receive(frame));
  EXPECT_EQ(rig.link->state(), BusState::Active);
  const CanStatistics s = rig.link->statistics();
  EXPECT_EQ(s.bus_offs, 1U);
  EXPECT_EQ(s.restarts, 1U);
  EXPECT_EQ(s.no_acknowledge, 1U);
  EXPECT_EQ(s.malformed, 1U);
  EXPECT_EQ(s.send_failures, 1U);
}

TEST(SlcanLink, AsksForTheStatusFlagsUntilToldThatThereAreNone) {
  SlcanSettings settings = kQuick;
  settings.flags_ns = 1;
  MemoryRig rig(settings);
  CanFrame frame;
  rig.link->receive(frame);
  EXPECT_EQ(rig.read(), "F\r");
  rig.say("F20\r");
  rig.link->receive(frame);
  EXPECT_EQ(rig.link->state(), BusState::Passive);
  rig.say("\a");
  rig.link->receive(frame);
  rig.read();
  rig.link->receive(frame);
  EXPECT_EQ(rig.read(), "");
  EXPECT_EQ(rig.link->statistics().send_failures, 0U);
}

TEST(SlcanLink, KeepsFramesWholeWhereTheLineTakesOnlyPartOfOne) {
  MemoryRig rig(kQuick, 20);  // of the 22 characters of a full frame
  const CanFrame full = make_frame(0x123, std::array<std::uint8_t, 8>{1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(rig.link->send(full), Sent::Taken);
  EXPECT_EQ(rig.link->send(make_frame(0x7FF, {})), Sent::Full);
  std::string all = rig.read();
  EXPECT_EQ(rig.link->send(make_frame(0x7FF, {})), Sent::Taken);
  all += rig.read();
  EXPECT_EQ(all, "t12380102030405060708\rt7FF0\r");
}

}  // namespace
}  // namespace tandem::bridges
