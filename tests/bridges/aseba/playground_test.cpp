// ASEBA's own simulated robot as the other side: asebaplayground (Debian package aseba), on a screen that nobody sees.
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/network.hpp"
#include "bridges/aseba/reopening_messages.hpp"

namespace tandem::bridges::aseba {
namespace {

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

bool installed(const char* program) {
  const char* path = std::getenv("PATH");
  std::string folders = path == nullptr ? "" : path;
  for (std::size_t at = 0; at <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    if (::access((folders.substr(at, end - at) + "/" + program).c_str(), X_OK) == 0) return true;
    at = end + 1;
  }
  return false;
}

std::uint16_t free_port() {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), size) != 0) return 0;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(fd);
  return ntohs(address.sin_port);
}

/// A program that runs until this object ends.
class Program {
 public:
  explicit Program(const std::string& command) : child_(::fork()) {
    if (child_ != 0) return;
    const std::string line = "exec " + command + " >/dev/null 2>&1";
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  ~Program() {
    ::kill(child_, SIGKILL);
    int status = 0;
    ::waitpid(child_, &status, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

 private:
  pid_t child_;
};

class Playground : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"asebaplayground", "Xvfb"}) {
      if (!installed(program)) GTEST_SKIP() << program << " is missing; apt-get install aseba xvfb libgl1-mesa-dri";
    }
    folder_ = std::filesystem::path(testing::TempDir()) / ("tandem_playground_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    port_ = free_port();
    std::ofstream(folder_ / "e.playground")
        << "<!DOCTYPE aseba-playground><aseba-playground><color name=\"wall\" r=\"0.9\" g=\"0.9\" b=\"0.9\"/>"
           "<world w=\"100\" h=\"100\" color=\"wall\"/><robot type=\"e-puck\" x=\"50\" y=\"50\" port=\""
        << port_ << "\" name=\"ep\"/></aseba-playground>";
    const std::string number = (folder_ / "display").string();
    screen_ = std::make_unique<Program>("Xvfb -displayfd 3 -nolisten tcp 3>" + number);
    for (int i = 0; i < 1000 && display_.empty(); ++i) {
      std::ifstream(number) >> display_;
      ::usleep(20'000);
    }
    ASSERT_FALSE(display_.empty()) << "Xvfb does not start";
    start();
    const auto opener = message_link_opener("tcp:127.0.0.1:" + std::to_string(port_));
    ASSERT_TRUE(opener.ok());
    link_ = std::make_unique<ReopeningMessages>(opener.value());
    network_ = std::make_unique<Network>(*link_);
  }
  void TearDown() override {
    robot_.reset();
    screen_.reset();
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  void start() {
    robot_ =
        std::make_unique<Program>("env DISPLAY=:" + display_ + " HOME=" + folder_.string() +
                                  " LIBGL_ALWAYS_SOFTWARE=1 asebaplayground " + (folder_ / "e.playground").string());
  }
  /// Serves the network until it holds, at most some time that is longer than any machine needs.
  bool serve_until(const std::function<bool()>& holds) {
    for (const hal::TimeNs end = monotonic_ns() + 60 * kSecond; monotonic_ns() < end;) {
      network_->poll(monotonic_ns());
      if (holds()) return true;
      link_->wait(5 * hal::kNsPerMs);
    }
    return false;
  }
  testing::AssertionResult read(std::size_t address, std::size_t count) {
    const hal::TimeNs asked = monotonic_ns();
    const bool wanted = network_->want(1, address, count);
    if (wanted && serve_until([&] { return network_->node(1).taken_ns(address, count) >= asked; })) {
      return testing::AssertionSuccess();
    }
    const NodeStatistics& s = network_->node(1).statistics;
    return testing::AssertionFailure() << "node " << node_state_name(network_->node(1).state) << ", " << s.messages
                                       << " messages, " << s.reads << " reads, " << s.asked_again << " asked again, "
                                       << s.answers << " answered, " << s.unanswered << " not, " << s.unasked
                                       << " unasked, " << s.wrong_length << " of a wrong length, lost " << s.times_lost
                                       << " times";
  }

  std::filesystem::path folder_;
  std::uint16_t port_ = 0;
  std::string display_;
  std::unique_ptr<Program> screen_;
  std::unique_ptr<Program> robot_;
  std::unique_ptr<ReopeningMessages> link_;
  std::unique_ptr<Network> network_;
};

TEST_F(Playground, DescribesItselfAndObeys) {
  ASSERT_TRUE(serve_until([&] { return network_->node(1).ready(); })) << link_->trouble();
  const Node& node = network_->node(1);
  EXPECT_EQ(node.version, 5);
  EXPECT_EQ(node.description.variables.size(), 14U);
  EXPECT_EQ(node.description.local_events.size(), 2U);
  EXPECT_EQ(node.description.native_functions.size(), 33U);
  for (const auto& [name, address, words] : {std::tuple{"id", 0, 1},
                                             {"args", 2, 32},
                                             {"_productId", 34, 1},
                                             {"speed.left", 35, 1},
                                             {"speed.right", 36, 1},
                                             {"prox", 40, 8},
                                             {"cam.red", 48, 60},
                                             {"cam.blue", 168, 60},
                                             {"energy", 228, 1}}) {
    const Variable* variable = node.description.variable(name);
    ASSERT_NE(variable, nullptr) << name;
    EXPECT_EQ(variable->address, address) << name;
    EXPECT_EQ(variable->words, words) << name;
  }
  EXPECT_EQ(node.statistics.impossible, 0U);
  EXPECT_EQ(node.statistics.not_understood, 0U);

  ASSERT_TRUE(read(0, 1));
  EXPECT_EQ(node.value(0), 1);
  ASSERT_TRUE(read(34, 1));
  EXPECT_EQ(node.value(34), 2);  // the product number of a simulated e-puck

  const std::array<std::int16_t, 2> speeds = {-300, 77};
  EXPECT_TRUE(network_->write(1, 35, speeds));
  ASSERT_TRUE(read(34, 4));
  EXPECT_EQ(node.value(35), -300);
  EXPECT_EQ(node.value(36), 77);

  ASSERT_TRUE(read(0, node.image.size()));  // all there is
  EXPECT_EQ(node.statistics.wrong_length, 0U);

  const std::array<std::int16_t, 3> arguments = {1, -2, 3};
  EXPECT_TRUE(network_->send_event(5, arguments));
  ASSERT_TRUE(read(2, 3));
  EXPECT_EQ(node.value(2), 1);
  EXPECT_EQ(node.value(3), -2);
  EXPECT_EQ(node.value(4), 3);
  EXPECT_EQ(network_->statistics().not_understood, 0U);
}

TEST_F(Playground, IsFoundAgainAfterItsEnd) {
  ASSERT_TRUE(serve_until([&] { return network_->node(1).ready(); })) << link_->trouble();
  robot_.reset();
  ASSERT_TRUE(serve_until([&] { return network_->node(1).state == NodeState::Lost; }));
  const std::array<std::int16_t, 1> speed = {1};
  EXPECT_FALSE(network_->write(1, 35, speed));
  start();
  ASSERT_TRUE(serve_until([&] { return network_->node(1).ready(); })) << link_->trouble();
  EXPECT_EQ(network_->node(1).generation, 2U);
  ASSERT_TRUE(read(35, 1));
  EXPECT_EQ(network_->node(1).value(35), 0);
}

}  // namespace
}  // namespace tandem::bridges::aseba
