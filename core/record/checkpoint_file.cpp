#include "core/record/checkpoint_file.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

#include "core/record/block_file.hpp"
#include "hal/json/json_access.hpp"
#include "hal/output_file.hpp"

namespace tandem::core {
namespace {

constexpr std::uint16_t kStart = 101, kState = 102, kEnd = 103;  // records have none of these
constexpr std::int64_t kVersion = 1;
constexpr std::size_t kPartBytes = std::size_t{64} << 20;
constexpr const char* kByteOrder = std::endian::native == std::endian::little ? "little" : "big";

/// What the system has taken is on the disk.
hal::Status sync(int descriptor, const std::string& path) {
  if (fsync(descriptor) == 0 || errno == EINVAL) return {};  // EINVAL: a pipe or a device
  return hal::Error{"checkpoint '" + path + "' cannot be written: " + std::strerror(errno)};
}

/// The name, too.
void sync_folder(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)fsync(descriptor);
  close(descriptor);
}

std::string start_text(const Checkpoint& checkpoint) {
  hal::Json start{{"checkpoint", kVersion},
                  {"byte_order", kByteOrder},
                  {"tick", checkpoint.tick},
                  {"fingerprint", checkpoint.fingerprint},
                  {"state_bytes", checkpoint.state.size()},
                  {"about", checkpoint.about}};
  if (checkpoint.touched) start["touched"] = true;
  if (!checkpoint.why_no_state.empty()) start["no_state"] = checkpoint.why_no_state;
  return hal::to_text(start);
}

}  // namespace

hal::Status write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  auto file = hal::OutputFile::open(path, "checkpoint");
  if (!file.ok()) return file.error();
  hal::Status done = file->write(kBlockFileStart);
  const auto write = [&](std::uint16_t type, std::string_view payload) {
    std::string block;
    append_block(block, type, checkpoint.tick, payload);
    if (done.ok()) done = file->write(block);
  };
  write(kStart, start_text(checkpoint));
  for (std::size_t at = 0; at < checkpoint.state.size(); at += kPartBytes)
    write(kState, std::string_view(checkpoint.state).substr(at, kPartBytes));
  write(kEnd, "");
  if (done.ok()) done = sync(file->descriptor(), path);
  if (done.ok()) done = file->commit();
  if (done.ok()) sync_folder(path);
  return done;
}

hal::Result<Checkpoint> read_checkpoint(const std::string& path) {
  const auto bad = [&path](const std::string& why) { return hal::Error{"checkpoint '" + path + "' " + why}; };
  auto opened = BlockFileReader::open(path);
  if (!opened.ok()) return opened.error();
  BlockFileReader& file = opened.value();
  const std::optional<Block> first = file.next();
  if (!first || !file.damage().empty()) return bad("is damaged: its beginning cannot be read");
  if (first->type != kStart) return bad("is a record, and no checkpoint");
  const auto start = hal::parse_json_object(first->payload);
  if (!start.ok()) return bad("is damaged: " + start.error().message);
  const hal::Json& json = start.value();
  if (hal::whole_of(json, "checkpoint") != kVersion) return bad("was written by another release");
  if (hal::text_of(json, "byte_order") != kByteOrder)
    return bad("was written by a processor with another order of bytes");
  Checkpoint checkpoint{hal::object_of(json, "about"),
                        hal::whole_of(json, "tick"),
                        hal::count_of(json, "fingerprint"),
                        hal::flag_of(json, "touched"),
                        {},
                        hal::text_of(json, "no_state")};
  checkpoint.state.reserve(std::min<std::size_t>(hal::count_of(json, "state_bytes"), file.size()));
  bool ended = false;
  while (const std::optional<Block> block = file.next()) {
    if (block->type == kState) checkpoint.state += block->payload;
    ended = ended || block->type == kEnd;
  }
  if (!file.damage().empty()) return bad("is damaged: " + file.damage().front());
  if (file.cut() || !ended || checkpoint.state.size() != hal::count_of(json, "state_bytes") || checkpoint.tick < 0)
    return bad("is not whole");
  return checkpoint;
}

}  // namespace tandem::core
