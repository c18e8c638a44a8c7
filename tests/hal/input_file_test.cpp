#include "hal/input_file.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace tandem::hal {
namespace {

namespace fs = std::filesystem;

class InputFile : public testing::Test {
 protected:
  InputFile() {
    std::string pattern = (fs::temp_directory_path() / "tandem_input_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~InputFile() override { fs::remove_all(folder_); }
  static std::string why_not(const std::string& path) {
    const auto read = read_whole_file(path, "the script");
    EXPECT_EQ(check_input_file(path, "the script").ok(), read.ok());
    return read.ok() ? "" : read.error().message;
  }
  fs::path folder_;
};

TEST_F(InputFile, IsReadWhole) {
  std::string bytes(200'001, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 31);
  std::ofstream(folder_ / "f", std::ios::binary) << bytes;
  std::ofstream(folder_ / "empty").flush();
  EXPECT_EQ(read_whole_file(folder_ / "f", "the script").value(), bytes);
  EXPECT_EQ(read_whole_file(folder_ / "empty", "the script").value(), "");
  EXPECT_FALSE(read_whole_file("/proc/self/status", "it").value().empty()) << "says that it has 0 bytes";
}

// A pipe without a writer and /dev/zero would keep a reader for ever.
TEST_F(InputFile, WhatMayNeverEndIsRefusedAtOnce) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(why_not(pipe), "the script '" + pipe + "': this is a pipe; give the path of a file");
  EXPECT_EQ(why_not("/dev/zero"), "the script '/dev/zero': this is a device; give the path of a file");
  EXPECT_EQ(why_not(folder_), "the script '" + folder_.string() + "': this is a folder; give the path of a file");
  fs::create_symlink("/dev/zero", folder_ / "link");
  EXPECT_NE(why_not(folder_ / "link").find("this is a device"), std::string::npos);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un at{};
  at.sun_family = AF_UNIX;
  const std::string name = folder_ / "s";
  name.copy(at.sun_path, sizeof at.sun_path - 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  EXPECT_NE(why_not(name).find("this is a socket"), std::string::npos);
  ::close(socket);
}

TEST_F(InputFile, SaysWhyItCannotBeRead) {
  EXPECT_EQ(why_not(folder_ / "none"), "the script '" + (folder_ / "none").string() + "': there is no such file");
  std::ofstream(folder_ / "large") << std::string(3'000'000, 'x');
  const auto large = read_whole_file(folder_ / "large", "the script", 2U << 20U);
  ASSERT_FALSE(large.ok());
  EXPECT_NE(large.error().message.find("larger than 2 MiB"), std::string::npos);
}

}  // namespace
}  // namespace tandem::hal
