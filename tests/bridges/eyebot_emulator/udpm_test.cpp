// The emulator on a network of its own, flown by a foreign peer while lcm-logger looks on.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <unistd.h>

#include "tests/bridges/eyebot_emulator/hand_written.hpp"
#include "tests/checkout.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// One event of a log of LCM's.
struct Record {
  std::int64_t number = 0;
  std::int64_t utime = 0;
  std::string channel;
  hand_written::Bytes data;
};

std::int64_t big_endian(const std::string& text, std::size_t at, std::size_t size) {
  std::uint64_t v = 0;
  for (std::size_t i = 0; i < size; ++i) v = v << 8U | static_cast<std::uint8_t>(text.at(at + i));
  return static_cast<std::int64_t>(v);
}

/// Sync word, number, time, two lengths, channel, data; the last one may be cut off.
std::vector<Record> read_lcm_log(const fs::path& file) {
  const std::string text = text_of(file);
  std::vector<Record> all;
  for (std::size_t at = 0; at + 28 <= text.size();) {
    EXPECT_EQ(big_endian(text, at, 4), 0xEDA1DA01) << "at " << at;
    const auto channel_size = static_cast<std::size_t>(big_endian(text, at + 20, 4));
    const auto data_size = static_cast<std::size_t>(big_endian(text, at + 24, 4));
    if (at + 28 + channel_size + data_size > text.size()) break;
    Record r{big_endian(text, at + 4, 8), big_endian(text, at + 12, 8), text.substr(at + 28, channel_size), {}};
    for (const char c : text.substr(at + 28 + channel_size, data_size)) r.data.push_back(static_cast<std::byte>(c));
    all.push_back(std::move(r));
    at += 28 + channel_size + data_size;
  }
  return all;
}

/// The value behind "key": in a line of the emulator's log.
std::string value(const std::string& line, const std::string& key) {
  const std::size_t at = line.find("\"" + key + "\":");
  if (at == std::string::npos) return {};
  const std::size_t from = at + key.size() + 3;
  if (line[from] == '"') return line.substr(from + 1, line.find('"', from + 1) - from - 1);
  return line.substr(from, line.find_first_of(",}", from) - from);
}

std::vector<std::string> lines_of(const std::string& log, const std::string& event) {
  std::vector<std::string> all;
  std::istringstream in(log);
  for (std::string line; std::getline(in, line);) {
    if (value(line, "event") == event) all.push_back(line);
  }
  return all;
}

/// One story, told once: what both witnesses have written down, and what the peer complains of.
class OnUdp : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    permitted_ = std::system("unshare -n true 2>/dev/null") == 0;
    if (!permitted_) return;
    std::string pattern = (fs::temp_directory_path() / "eyebot_on_udp_XXXXXX").string();
    const fs::path folder = mkdtemp(pattern.data());
    const std::string peer = std::string(test::kSourceDir) + "/tests/bridges/eyebot_emulator/peer.py";
    const std::string command = "unshare -n sh -c 'ip link set lo up; ip route add 224.0.0.0/4 dev lo; exec python3 " +
                                peer + " " + test::kBuildDir + "/bin/tandem " + TANDEM_PEER_TYPES + " " +
                                folder.string() + "' > " + (folder / "peer.txt").string() + " 2>&1";
    code_ = std::system(command.c_str());
    complaint_ = text_of(folder / "peer.txt");
    log_ = text_of(folder / "robot.jsonl");
    witness_ = read_lcm_log(folder / "witness.lcm");
    fs::remove_all(folder);
  }
  void SetUp() override {
    if (!permitted_) GTEST_SKIP() << "this machine does not permit a network of its own (unshare -n, as root)";
  }

  static inline bool permitted_ = false;
  static inline int code_ = -1;
  static inline std::string complaint_;
  static inline std::string log_;
  static inline std::vector<Record> witness_;
};

TEST_F(OnUdp, TheRobotDoesWhatAForeignHubAsksFor) {
  EXPECT_EQ(code_, 0) << complaint_;
}

TEST_F(OnUdp, WithoutItsHubItHoversAndThenLands) {
  std::string modes;
  for (const std::string& line : lines_of(log_, "mode")) modes += value(line, "to") + " ";
  EXPECT_THAT(modes, HasSubstr("velocity hover land idle "));
  const auto failsafes = lines_of(log_, "failsafe");
  ASSERT_FALSE(failsafes.empty());
  EXPECT_EQ(value(failsafes.back(), "to"), "link_lost");
  // What was said last is long before: nothing that is stale was obeyed.
  const auto commands = lines_of(log_, "command");
  ASSERT_FALSE(commands.empty());
  EXPECT_EQ(value(commands.back(), "channel"), "cmd/velocity");
  const auto landed = lines_of(log_, "landed");
  ASSERT_EQ(landed.size(), 1U);
  EXPECT_LT(std::stod(value(landed[0], "speed_m_s")), 0.35);
}

/// Whether `part` is left when some of `whole` are taken out: datagrams may be lost where the machine is busy.
template <class T>
bool in_this_order(const std::vector<T>& part, const std::vector<T>& whole) {
  auto next = part.begin();
  for (const T& one : whole) {
    if (next != part.end() && *next == one) ++next;
  }
  return next == part.end();
}

TEST_F(OnUdp, TheWitnessHasSeenTheSameCommands) {
  std::vector<std::string> seen;
  for (const Record& r : witness_) {
    if (!r.channel.starts_with("eyebot/eb0/cmd/")) continue;
    const std::string topic = r.channel.substr(std::string("eyebot/eb0/").size());
    hand_written::Reader reader(r.data);
    const auto known = hand_written::kFingerprints.find(topic);
    const bool whole = r.data.size() == (topic == "cmd/mode" ? 29U : topic == "cmd/velocity" ? 61U : 66U);
    if (!whole || known == hand_written::kFingerprints.end() || reader.fingerprint() != known->second) continue;
    const auto head = reader.head();
    seen.push_back(topic + " " + std::to_string(head.session) + " " + std::to_string(head.seq) + " " +
                   std::to_string(head.utime));
  }
  std::vector<std::string> told;
  for (const std::string& line : lines_of(log_, "command")) {
    told.push_back(value(line, "channel") + " " + value(line, "session") + " " + value(line, "seq") + " " +
                   value(line, "utime"));
  }
  EXPECT_GT(told.size(), 14U);
  EXPECT_TRUE(in_this_order(seen, told)) << testing::PrintToString(seen) << "\nof\n" << testing::PrintToString(told);
  EXPECT_GE(seen.size() * 4, told.size() * 3) << "a busy machine may lose some";
}

TEST_F(OnUdp, TheWitnessHasSeenTheSameModes) {
  const std::map<std::string, int> numbers = {{"idle", 1},     {"takeoff", 2}, {"hover", 3}, {"position", 4},
                                              {"velocity", 5}, {"land", 6},    {"off", 0}};
  std::vector<int> seen;
  for (const Record& r : witness_) {
    if (r.channel != "eyebot/eb0/status") continue;
    const int mode = hand_written::read_status(r.data).mode;
    if (seen.empty() || seen.back() != mode) seen.push_back(mode);
  }
  std::vector<int> told;
  for (const std::string& line : lines_of(log_, "mode")) told.push_back(numbers.at(value(line, "to")));
  EXPECT_TRUE(in_this_order(seen, told)) << testing::PrintToString(seen) << "\nof\n" << testing::PrintToString(told);
  EXPECT_GE(seen.size() * 4, told.size() * 3) << "a busy machine may lose some";
}

TEST_F(OnUdp, TheWitnessHasSeenEveryReport) {
  std::map<std::string, std::vector<std::int32_t>> numbers;
  for (const Record& r : witness_) {
    if (!r.channel.starts_with("eyebot/eb0/") || r.channel.starts_with("eyebot/eb0/cmd/")) continue;
    hand_written::Reader reader(r.data);
    reader.fingerprint();
    numbers[r.channel].push_back(reader.head().seq);
  }
  const auto sent = lines_of(log_, "sent");
  EXPECT_EQ(sent.size(), numbers.size());
  EXPECT_GE(sent.size(), 11U);
  for (const std::string& line : sent) {
    const auto& seen = numbers[value(line, "channel")];
    ASSERT_FALSE(seen.empty()) << line;
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end())) << line;
    const std::int32_t last = std::stoi(value(line, "last_seq"));
    EXPECT_LE(seen.back(), last) << line;
    const std::int32_t span = last - seen.front() + 1;
    EXPECT_GE(static_cast<double>(seen.size()), 0.9 * span) << "a busy machine may lose some; " << line;
  }
}

TEST_F(OnUdp, WhatIsNoMessageIsTold) {
  std::map<std::string, int> told;
  for (const std::string& line : lines_of(log_, "malformed")) ++told[value(line, "channel")];
  for (const char* channel :
       {"eyebot/eb0/cmd/rab", "hub/evil/heartbeat", "eyebot/eb0/cmd/mode", "eyebot/eb0/cmd/position"}) {
    EXPECT_EQ(told[channel], 1) << channel;
  }
}

TEST_F(OnUdp, TimesFromSensingToActingCanBeReadFromTheLog) {
  int timed = 0;
  for (const std::string& line : lines_of(log_, "command")) {
    if (value(line, "first") != "true") continue;
    EXPECT_GT(std::stoll(value(line, "t_ns")), std::stoll(value(line, "state_sent_ns"))) << line;
    ++timed;
  }
  EXPECT_GT(timed, 5);
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
