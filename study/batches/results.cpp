#include "study/batches/results.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>
#include <utility>

#include "core/record/block_file.hpp"

namespace tandem::study {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kOutcome = 1;
constexpr const char* kEnding = ".results";

}  // namespace

hal::Result<ResultsWriter> ResultsWriter::open(const std::string& folder, std::size_t batch) {
  // Of a name that no other process has, on whatever computer: the system chooses the letters, and makes the file.
  std::string path = (fs::path(folder) / ("batch-" + std::to_string(batch) + "-XXXXXX" + kEnding)).string();
  const int fd = mkostemps(path.data(), static_cast<int>(std::strlen(kEnding)), O_CLOEXEC);
  if (fd < 0) return hal::Error{"results cannot be written into '" + folder + "': " + std::strerror(errno)};
  ResultsWriter writer(std::move(path), fd);
  if (const hal::Status begun = writer.write(core::kBlockFileStart); !begun.ok()) return begun.error();
  return writer;
}

ResultsWriter::ResultsWriter(ResultsWriter&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}

ResultsWriter::~ResultsWriter() {
  if (fd_ >= 0) ::close(fd_);
}

hal::Status ResultsWriter::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return hal::Error{"'" + path_ + "' cannot be written: " + std::strerror(n < 0 ? errno : ENOSPC)};
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  if (::fdatasync(fd_) != 0 && errno != EINVAL)
    return hal::Error{"'" + path_ + "' cannot be written: " + std::strerror(errno)};
  return {};
}

hal::Status ResultsWriter::add(std::span<const FinishedRun> runs) {
  std::string blocks;
  for (const FinishedRun& run : runs)
    core::append_block(blocks, kOutcome, run.plan.number, message_of(run.plan.number, run.outcome));
  return write(blocks);
}

std::vector<ToldOutcome> ResultsReader::look() {
  std::vector<ToldOutcome> told;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    if (entry.path().extension() != kEnding) continue;
    const std::string path = entry.path().string();
    std::size_t& read = read_[path];
    if (entry.file_size(error) <= read || error) continue;
    auto reader = core::BlockFileReader::open(path);
    if (!reader.ok()) continue;  // not begun yet
    if (read > 0) reader->go_to(read);
    while (const auto block = reader->next()) {
      read = block->at + core::kBlockHeaderBytes + block->payload.size();
      if (block->type != kOutcome) continue;
      std::string message(block->payload);
      if (auto outcome = take_message(message)) told.push_back(std::move(*outcome));
    }
  }
  return told;
}

}  // namespace tandem::study
