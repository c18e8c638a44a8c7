// The whole emulator on real pseudo-terminals and sockets. The host's side is plain POSIX, and a foreign CAN library.
#include "bridges/footbot_emulator/emulator.hpp"

#include <arpa/inet.h>
#include <chrono>
#include <condition_variable>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mutex>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "tests/checkout.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr auto kPatience = std::chrono::seconds(10);  // for what must happen; nothing takes nearly as long

struct Folder {
  fs::path path =
      fs::temp_directory_path() / ("footbot_emulator_" + std::to_string(getpid()) + "_" + std::to_string(next()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  static int next() {
    static int n = 0;
    return n++;
  }
};

/// An emulator on a thread of its own.
class Running {
 public:
  explicit Running(Options options = {}) {
    if (options.link == Options{}.link) options.link = "pty:" + (folder_.path / "fb0").string();
    options.log_file = (folder_.path / "log.json").string();
    options.ready = [this](const std::string& where) { ready_.set_value(where); };
    options.events = [this](hal::TimeNs at, std::string_view name, const EventFields& fields) {
      const std::lock_guard lock(guard_);
      events_.push_back(to_json(at, name, fields));
      news_.notify_all();
    };
    thread_ = std::thread([this, options] { status_ = run(options, stop_); });
    auto where = ready_.get_future();
    EXPECT_EQ(where.wait_for(kPatience), std::future_status::ready);
    path_ = where.get();
  }
  ~Running() { stop_and_join(); }

  hal::Status end() {
    stop_and_join();
    return status_;
  }
  /// What a host opens: a device, or tcp:HOST:PORT.
  const std::string& path() const { return path_; }
  std::uint16_t port() const { return static_cast<std::uint16_t>(std::stoi(path_.substr(path_.rfind(':') + 1))); }
  std::string log_text() const {
    std::ifstream file(folder_.path / "log.json");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Waits until `count` events contain `what`.
  bool happened(const std::string& what, int count = 1) {
    std::unique_lock lock(guard_);
    return news_.wait_for(lock, kPatience, [&] {
      return std::count_if(events_.begin(), events_.end(),
                           [&](const std::string& e) { return e.find(what) != std::string::npos; }) >= count;
    });
  }

 private:
  void stop_and_join() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  Folder folder_;
  std::promise<std::string> ready_;
  std::string path_;
  std::mutex guard_;
  std::condition_variable news_;
  std::vector<std::string> events_;
  std::atomic<bool> stop_{false};
  hal::Status status_;
  std::thread thread_;
};

/// A descriptor and what came out of it.
class Peer {
 public:
  explicit Peer(int descriptor) : descriptor_(descriptor) { EXPECT_GE(descriptor, 0); }
  ~Peer() { close(); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  void close() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }
  void write(const std::string& text) {
    ASSERT_EQ(::write(descriptor_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// Reads until `text` has come. False: it did not, or the other end has gone.
  bool hears(const std::string& text, std::chrono::milliseconds patience = kPatience) {
    const auto end = Clock::now() + patience;
    while (heard.find(text) == std::string::npos) {
      pollfd p{descriptor_, POLLIN, 0};
      std::array<char, 4096> buffer{};
      if (::poll(&p, 1, 100) > 0) {
        const ssize_t n = ::read(descriptor_, buffer.data(), buffer.size());
        if (n <= 0) return false;
        heard.append(buffer.data(), static_cast<std::size_t>(n));
      }
      if (Clock::now() > end) return false;
    }
    return true;
  }
  /// The other end is closed within reasonable time.
  bool is_cut_off() {
    (void)hears("nobody says this");
    pollfd p{descriptor_, POLLIN, 0};
    char byte = 0;
    return ::poll(&p, 1, 0) > 0 && ::read(descriptor_, &byte, 1) <= 0;
  }
  std::string heard;

 private:
  int descriptor_;
};

int open_terminal(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  tcgetattr(descriptor, &settings);
  cfmakeraw(&settings);
  tcsetattr(descriptor, TCSANOW, &settings);
  return descriptor;
}

int connect_to(std::uint16_t port) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return descriptor;
}

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int v : values) text += static_cast<char>(v);
  return text;
}

Options with(const std::string& link, std::vector<std::string> faults = {}, const std::string& firmware = "v5") {
  Options options;
  options.link = link;
  options.faults = std::move(faults);
  options.firmware = firmware;
  return options;
}

TEST(EmulatedAdapter, CarriesAConversation) {
  Running emulator(with("pty:fb0"));
  Peer host(open_terminal(emulator.path()));
  host.write("\r\r\rC\rV\rS8\rO\r");
  ASSERT_TRUE(host.hears("V1013\r\r\r")) << host.heard;
  host.write("t300411A00500\r");
  for (int id = 1; id <= 9; ++id) EXPECT_TRUE(host.hears("t30" + std::to_string(id) + "40C900500\r"));
  host.write("t30080BA0010000000400\r");
  EXPECT_TRUE(host.hears("t10180590000001000000\rt201400000000\r")) << host.heard;
  host.write("t30080CA0010022001E00\r");
  EXPECT_TRUE(emulator.happened(R"("event":"wheels","left":30,"right":0)"));
  host.write("t30080BA0010022000100\r");
  EXPECT_TRUE(host.hears("t3016059022001E00\r")) << host.heard;
  ASSERT_TRUE(emulator.end().ok());
  const std::string log = emulator.log_text();
  EXPECT_THAT(log, HasSubstr(R"("event":"end","why":"stopped","left":30,"right":0,"wheels_commanded_t_ns":)"));
  EXPECT_FALSE(fs::exists(emulator.path())) << "the pseudo-terminal is taken away";
}

TEST(EmulatedAdapter, HasFaultsWhenItIsDrivenAndNoneWhenItNeverIs) {
  const std::string fault = R"("event":"fault","fault":"silent=left-motor@drive","phase":"begin")";
  Running emulator(with("pty:fb0", {"silent=left-motor@drive", "restart=base@drive+1000s"}));
  Running never(with("pty:fb0", {"silent=left-motor@drive", "hangup@drive+0s"}));
  Peer host(open_terminal(emulator.path()));
  host.write("S8\rO\rt30080BA0010022000100\r");
  EXPECT_TRUE(host.hears("t3016059022000000\r")) << host.heard;
  EXPECT_EQ(emulator.log_text().find(fault), std::string::npos);
  host.write("t30080CA0010022001E00\r");
  EXPECT_TRUE(emulator.happened(fault));
  host.heard.clear();
  host.write("t30080BA0010022000100\rt30080BA0090000000600\r");
  EXPECT_TRUE(host.hears("t209")) << "the base is heard: " << host.heard;
  ASSERT_TRUE(emulator.end().ok());
  ASSERT_TRUE(never.end().ok());
  EXPECT_EQ(host.heard.find("t301605902200"), std::string::npos) << host.heard;
  EXPECT_EQ(never.log_text().find("\"event\":\"fault\""), std::string::npos);
}

TEST(EmulatedAdapter, DescribesAModuleFrameByFrame) {
  Running emulator(with("pty:fb0", {}, "v4"));
  Peer host(open_terminal(emulator.path()));
  host.write("S8\rO\rt300400A00400\r");
  EXPECT_TRUE(host.hears("t101800900A6C65667420\r")) << host.heard;  // "left "
  EXPECT_TRUE(host.hears("t00186D6F746F72040000\r")) << host.heard;
  EXPECT_TRUE(host.hears("t10180190010005737065\r")) << host.heard;
  // Nine modules speak at once, each in its own order.
  EXPECT_TRUE(host.hears("t20")) << host.heard;
  EXPECT_LT(host.heard.find("t101800900A6C65667420\r"), host.heard.find("t00186D6F746F72040000\r"));
}

TEST(EmulatedSwitch, CarriesAConversation) {
  Running emulator(with("tcp-listen:127.0.0.1:0"));
  Peer host(connect_to(emulator.port()));
  host.write(bytes({2, 0, 0, 0, 0x11, 0xA0, 5, 0}));
  for (int id = 1; id <= 9; ++id) EXPECT_TRUE(host.hears(bytes({2, 0, id, 0, 0x0C, 0x90, 5, 0}))) << id;
  host.write(bytes({6, 0, 0, 0, 0x0B, 0xA0, 1, 0, 0, 0, 4, 0}));
  EXPECT_TRUE(host.hears(bytes({10, 0, 1, 0, 0x05, 0x90, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0})));
  host.write(bytes({6, 0, 0, 0, 0x0C, 0xA0, 1, 0, 34, 0, 0xF6, 0xFF}));
  EXPECT_TRUE(emulator.happened(R"("event":"wheels","left":-10,"right":0)"));
  host.write(bytes({4, 0, 0, 0, 0x10, 0xA0, 1, 0, 5, 0}));
  EXPECT_TRUE(
      host.hears(bytes({0x19, 0, 1, 0, 0x00, 0x90, 10, 'l', 'e', 'f', 't', ' ', 'm', 'o', 't', 'o', 'r', 5, 0})));
}

TEST(EmulatedSwitch, ServesSeveralHosts) {
  Running emulator(with("tcp-listen:127.0.0.1:0"));
  Peer one(connect_to(emulator.port()));
  Peer other(connect_to(emulator.port()));
  ASSERT_TRUE(emulator.happened(R"("hosts":2)"));
  const std::string question = bytes({6, 0, 0, 0, 0x0B, 0xA0, 2, 0, 34, 0, 1, 0});
  const std::string answer = bytes({4, 0, 2, 0, 0x05, 0x90, 34, 0, 0, 0});
  one.write(question);
  EXPECT_TRUE(one.hears(answer));
  EXPECT_TRUE(other.hears(answer));
  EXPECT_TRUE(other.hears(question)) << "what one says the other hears";
  EXPECT_EQ(one.heard.find(question), std::string::npos);
  one.close();
  EXPECT_TRUE(emulator.happened(R"("hosts":1)", 2));
  other.heard.clear();
  other.write(question);
  EXPECT_TRUE(other.hears(answer));
}

TEST(EmulatedSwitch, AHostThatFloodsTheBusDoesNotLockOutAnother) {
  Running emulator(with("tcp-listen:0"));
  Peer host(connect_to(emulator.port()));
  ASSERT_TRUE(emulator.happened(R"("hosts":1)"));
  std::atomic<bool> enough{false};
  std::thread flood([&, descriptor = connect_to(emulator.port())] {
    const std::string empty(6 * 1000, '\0');  // a thousand messages without content
    while (!enough && ::send(descriptor, empty.data(), empty.size(), MSG_NOSIGNAL | MSG_DONTWAIT) != 0) continue;
    ::close(descriptor);
  });
  ASSERT_TRUE(emulator.happened(R"("hosts":2)"));
  int answers = 0;
  for (int i = 0; i < 100 && answers < 20; ++i) {  // a question may be lost on a bus that is full: hosts ask again
    host.heard.clear();
    host.write(bytes({6, 0, 0, 0, 0x0B, 0xA0, 1, 0, 34, 0, 1, 0}));
    const std::string answer = bytes({4, 0, 1, 0, 0x05, 0x90, 34, 0, 0, 0});
    answers += host.hears(answer, std::chrono::milliseconds(500)) ? 1 : 0;
  }
  EXPECT_EQ(answers, 20);
  enough = true;
  flood.join();
}

TEST(EmulatedSwitch, IsReachedFromThisComputerAloneUnlessItIsToldOtherwise) {
  Running emulator(with("tcp-listen:0"));
  EXPECT_THAT(emulator.path(), testing::StartsWith("tcp:127.0.0.1:"));
  sockaddr_in elsewhere{};
  elsewhere.sin_family = AF_INET;
  elsewhere.sin_port = htons(static_cast<std::uint16_t>(emulator.port()));
  elsewhere.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);  // 127.0.0.2: this computer by another address
  const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  EXPECT_NE(::connect(descriptor, reinterpret_cast<const sockaddr*>(&elsewhere), sizeof elsewhere), 0);
  ::close(descriptor);
  Running everywhere(with("tcp-listen:0.0.0.0:0"));
  elsewhere.sin_port = htons(static_cast<std::uint16_t>(everywhere.port()));
  const int other = ::socket(AF_INET, SOCK_STREAM, 0);
  EXPECT_EQ(::connect(other, reinterpret_cast<const sockaddr*>(&elsewhere), sizeof elsewhere), 0);
  ::close(other);
}

TEST(EmulatedSwitch, CutsOffWhoTalksNonsense) {
  Running emulator(with("tcp-listen:127.0.0.1:0"));
  Peer host(connect_to(emulator.port()));
  host.write(std::string(100, '\xFF'));
  EXPECT_TRUE(emulator.happened("too long"));
  EXPECT_TRUE(host.is_cut_off());
  Peer again(connect_to(emulator.port()));
  again.write(bytes({2, 0, 0, 0, 0x11, 0xA0, 5, 0}));
  EXPECT_TRUE(again.hears(bytes({2, 0, 9, 0, 0x0C, 0x90, 5, 0})));
}

TEST(EmulatedSwitch, HangsUpAndComesBackAtTheSamePlace) {
  Running emulator(with("tcp-listen:127.0.0.1:0", {"hangup@500ms+100ms"}));
  Peer host(connect_to(emulator.port()));
  host.write(bytes({6, 0, 0, 0, 0x0C, 0xA0, 1, 0, 34, 0, 10, 0}));
  EXPECT_TRUE(emulator.happened(R"("phase":"end")"));
  EXPECT_TRUE(host.is_cut_off());
  Peer again(connect_to(emulator.port()));
  again.write(bytes({6, 0, 0, 0, 0x0B, 0xA0, 1, 0, 34, 0, 1, 0}));
  EXPECT_TRUE(again.hears(bytes({4, 0, 1, 0, 0x05, 0x90, 34, 0, 10, 0}))) << "it has driven on";
}

TEST(Emulator, ShowsItsFaults) {
  Running emulator(with("pty:fb0", {"missing=2", "silent=3"}));
  Peer host(open_terminal(emulator.path()));
  host.write("S8\rO\rt300411A00500\r");
  EXPECT_TRUE(host.hears("t30940C900500\r"));
  EXPECT_EQ(host.heard.find("t30240C"), std::string::npos);
  EXPECT_EQ(host.heard.find("t30340C"), std::string::npos);
  EXPECT_TRUE(emulator.happened(R"("event":"fault","fault":"missing=2","phase":"begin")"));
}

TEST(Emulator, SaysWhatIsWrong) {
  const std::atomic<bool> stop{true};
  const auto fails = [&](const Options& options, const std::string& part) {
    const hal::Status status = run(options, stop);
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message, HasSubstr(part));
  };
  fails(with("pigeon:post"), "tcp-listen:PORT");
  fails(with("pty:/nowhere/at/all"), "/nowhere/at/all");
  fails(with("tcp-listen:70000"), "70000");
  fails(with("tcp-listen:"), "tcp-listen:33333");
  fails(with("can:no_such_bus"), "can:no_such_bus");
  fails(with("pty:x", {"explode@3s"}), "explode");
  fails(with("pty:x", {}, "v6"), "'v6'");
  Options unwritable = with("pty:x");
  unwritable.log_file = "/nowhere/at/all";
  fails(unwritable, "/nowhere/at/all");
}

/// A Python that has python-can; empty: none. The first python3 of the path may be another than Debian's.
std::string python_with_can() {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (std::system((std::string(python) + " -c 'import can, serial' >/dev/null 2>&1").c_str()) == 0) return python;
  }
  return {};
}

TEST(Emulator, IsUnderstoodByAForeignLibrary) {
  const std::string python = python_with_can();
  if (python.empty()) GTEST_SKIP() << "python-can is not installed (Debian packages: python3-can python3-serial)";
  Running emulator(with("pty:fb0"));
  const std::string script = std::string(test::kSourceDir) + "/tests/bridges/footbot_emulator/can_peer.py";
  EXPECT_EQ(std::system((python + " " + script + " " + emulator.path()).c_str()), 0);
  EXPECT_TRUE(emulator.happened(R"("event":"wheels","left":30,"right":0)"));
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
