// Records, fed with anything that a file may hold.
//
// Two uses of one input: its bytes as a file; and as payloads of blocks with right checksums behind a good beginning,
// so that they are looked into. The promises: no crash, no undefined behaviour; every value of rows that are given can
// be read, and what makes no sense is told.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

#include "core/record/block_file.hpp"
#include "core/record/floor_image.hpp"
#include "core/record/record_moments.hpp"
#include "core/record/record_reader.hpp"
#include "core/record/scene_json.hpp"

namespace {

using namespace tandem::core;

void expect(bool condition) {
  if (!condition) std::abort();
}

/// There and back: whatever tick is asked for, one that has poses is shown.
void look_through(RecordMoments& moments) {
  const auto look = [&moments] {
    const std::vector<tandem::hal::Tick>& ticks = moments.ticks();
    expect(std::binary_search(ticks.begin(), ticks.end(), moments.tick()));
    expect(moments.rows("pose") != nullptr);
    (void)sketch_of_json(moments.sketch());
    (void)floor_of_png(moments.floor_png());
  };
  look();
  while (moments.next()) look();
  for (tandem::hal::Tick tick = 40; tick >= -2; tick -= 3) {
    moments.go_to(tick);
    look();
  }
}

void read(const std::string& text) {
  const int fd = ::memfd_create("record", MFD_CLOEXEC);
  expect(fd >= 0 && ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  auto reader = RecordReader::open("/proc/self/fd/" + std::to_string(fd));
  if (!reader.ok()) {
    ::close(fd);
    return expect(!reader.error().message.empty());
  }
  if (auto moments = RecordMoments::open("/proc/self/fd/" + std::to_string(fd)); moments.ok())
    look_through(moments.value());
  ::close(fd);
  double sum = 0.0;
  while (const auto entry = reader.value().next()) {
    if (!entry->rows) continue;
    const RecordRows& rows = *entry->rows;
    for (std::size_t field = 0; field < rows.stream().fields.size(); ++field) {
      for (std::size_t row = 0; row < rows.size(); ++row) {
        expect(rows.used(field, row) <= rows.stream().fields[field].count);
        for (std::size_t i = 0; i < rows.used(field, row); ++i) sum += rows.value(field, row, i);
      }
    }
  }
  (void)sum;
  (void)reader.value().damage();
  (void)reader.value().events();
  for (std::size_t i = 0; i < reader.value().ticks().size(); ++i) (void)reader.value().standing(i);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  read(input);
  read(std::string(kBlockFileStart) + input);

  std::string file(kBlockFileStart);
  append_block(file, 1, -1, R"({"seed":1})");
  append_block(
      file, 2, -1,
      R"({"stream":1,"of":"robot","set":"sensor","name":"s","fields":[{"name":"n","type":"u8","count":1},)"
      R"({"name":"v","type":"f32","count":6,"used_by":"n","per_entry":2},{"name":"x","type":"i32","scale":1e-6}]})");
  append_block(
      file, 2, -1,
      R"({"stream":2,"of":"robot","set":"pose","name":"pose","fields":[{"name":"x","type":"u8"},{"name":"y","type":"u8"},)"
      R"({"name":"z","type":"u8"},{"name":"heading","type":"u8"}]})");
  append_block(file, 3, -1, R"({"members":1,"ids":["a","b"],"kinds":["k"],"kind":[0,0],"real":[1]})");
  for (std::size_t at = 0; at + 2 <= size;) {
    const std::uint16_t type = data[at] % 13;
    const std::size_t length = std::min<std::size_t>(data[at + 1], size - at - 2);
    std::string payload = input.substr(at + 2, length);
    if (type == 4 && length > 0 && data[at + 2] % 2 == 0)  // rows of the stream above
      payload =
          std::string(data[at + 2] % 4 == 0 ? "\2\0\0\0\1\0\0\0\2\0\0\0\0\0\0\0" : "\1\0\0\0\1\0\0\0\2\0\0\0\0\0\0\0",
                      16) +
          payload;
    append_block(file, type, static_cast<std::int64_t>(at % 32), payload);
    at += 2 + length;
  }
  read(file);
  return 0;
}
