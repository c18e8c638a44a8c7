// Checkpoint files, and what controllers and hooks remember, fed with anything that a file may hold.
//
// Uses of one input: its bytes as a file; as payloads of blocks with right checksums behind a good beginning; written
// over places of a whole file; and as what an archive reads. The promises: no crash, no undefined behaviour, no more
// memory than the bytes are worth; a file that is read is whole, and what is not has a message.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <variant>
#include <vector>

#include "core/record/block_file.hpp"
#include "core/record/checkpoint_file.hpp"
#include "hal/archive.hpp"

namespace {

using namespace tandem;

void expect(bool condition) {
  if (!condition) std::abort();
}

bool read(const std::string& text) {
  const int fd = ::memfd_create("checkpoint", MFD_CLOEXEC);
  expect(fd >= 0 && ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  const auto checkpoint = core::read_checkpoint("/proc/self/fd/" + std::to_string(fd));
  ::close(fd);
  if (!checkpoint.ok()) expect(!checkpoint.error().message.empty());
  if (checkpoint.ok()) expect(checkpoint.value().tick >= 0 && checkpoint.value().state.size() <= text.size());
  return checkpoint.ok();
}

/// Everything that an archive knows.
struct Everything {
  struct Part {
    std::string name;
    std::vector<double> values;
    void remember(hal::Archive& a) { a(name, values); }
  };
  int number = 1;
  std::vector<Part> parts{{"a", {1.0, 2.0}}, {"b", {}}};
  std::deque<std::string> texts{"x", "yy"};
  std::map<std::string, std::vector<int>> lists{{"k", {1, 2}}};
  std::set<std::int64_t> numbers{3, 4};
  std::optional<std::string> maybe = "z";
  std::variant<std::monostate, double, std::string> one = 2.5;
  std::pair<std::string, int> pair{"p", 1};
  std::mt19937_64 chance{7};
  void remember(hal::Archive& a) { a(number, parts, texts, lists, numbers, maybe, one, pair, chance); }
};

std::string whole_file() {
  std::string file(core::kBlockFileStart);
  core::append_block(file, 101, 5,
                     R"({"checkpoint":1,"byte_order":"little","tick":5,"fingerprint":18446744073709551615,)"
                     R"("state_bytes":6,"about":{"seed":1}})");
  core::append_block(file, 102, 5, "abc");
  core::append_block(file, 102, 5, "def");
  core::append_block(file, 103, 5, "");
  return file;
}

void remember(const std::string& input) {
  hal::Archive writer;
  Everything all;
  all.remember(writer);
  hal::Archive again(writer.bytes());
  Everything copy;
  copy.remember(again);
  expect(again.at_end());

  std::string bytes = writer.bytes();
  for (std::size_t i = 0; i + 2 < input.size() && i < 30; i += 3) {
    const std::size_t at = static_cast<unsigned char>(input[i]) + 256U * static_cast<unsigned char>(input[i + 1]);
    bytes[at % bytes.size()] = input[i + 2];
  }
  for (const std::string& some : {bytes, input, bytes.substr(0, input.size() % bytes.size())}) {
    hal::Archive reader(some);
    Everything read;
    read.remember(reader);
    expect(read.parts.size() + read.texts.size() + read.lists.size() <= 4 * some.size() + 8);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  (void)read(input);
  (void)read(std::string(core::kBlockFileStart) + input);

  const std::string whole = whole_file();
  expect(read(whole));
  std::string changed = whole;
  for (std::size_t i = 0; i + 1 < size && i < 8; i += 2) changed[data[i] % changed.size()] = input[i + 1];
  expect(read(changed) == (changed == whole));  // no damage goes unnoticed
  (void)read(whole.substr(0, size % whole.size()));

  std::string file(core::kBlockFileStart);
  for (std::size_t at = 0; at + 2 <= size;) {
    const std::size_t length = std::min<std::size_t>(data[at + 1], size - at - 2);
    core::append_block(file, static_cast<std::uint16_t>(100 + data[at] % 5), 5, input.substr(at + 2, length));
    at += 2 + length;
  }
  (void)read(file);
  remember(input);
  return 0;
}
