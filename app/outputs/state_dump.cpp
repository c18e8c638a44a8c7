#include "app/outputs/state_dump.hpp"

#include <charconv>

#include "core/record/csv.hpp"
#include "hal/input_file.hpp"

namespace tandem::app {
namespace {

constexpr std::string_view kHeader = "tick,who,what,field,value";

std::string uncell(const std::string& cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
  std::string text;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"') ++i;
  }
  return text;
}

/// Cuts the last cell off, which has no comma in it.
std::string cut_last(std::string& line) {
  const std::size_t comma = line.rfind(',');
  if (comma == std::string::npos) return {};
  std::string last = line.substr(comma + 1);
  line.resize(comma);
  return last;
}

}  // namespace

hal::Result<StateDump> StateDump::open(const std::string& path, std::int64_t every) {
  auto file = hal::OutputFile::open(path, "dump");
  if (!file.ok()) return file.error();
  StateDump dump(std::move(file).value(), every);
  dump.state_ = dump.file_.write(std::string(kHeader) + "\n");
  if (!dump.state_.ok()) return dump.state_.error();
  return dump;
}

hal::Status StateDump::write(const core::StateView& state) {
  if (!state_.ok()) return state_;
  written_ = state.tick;
  std::string text;
  const std::string tick = std::to_string(state.tick) + ",";
  for (const core::StateValue& v : core::state_values(state))
    text += tick + core::csv_cell(v.who) + "," + v.what + "," + v.field + "," + v.value + "\n";
  state_ = file_.write(text);
  return state_;
}

hal::Status StateDump::tick_done(const core::StateView& state) {
  if (every_ == 0 || state.tick % every_ != 0 || !state_.ok()) return {};
  return write(state);
}

hal::Status StateDump::close(const core::StateView& state) {
  if (written_ != state.tick) (void)write(state);
  if (state_.ok()) return file_.commit();
  file_.keep_part();
  return state_;
}

bool StateDumpReader::is_dump(const std::string& path) {
  if (!hal::check_input_file(path, "").ok()) return false;
  std::ifstream in(path);
  std::string line;
  return std::getline(in, line) && line == kHeader;
}

StateDumpReader::StateDumpReader(const std::string& path) : path_(path), in_(path) {
  std::string header;
  std::getline(in_, header);
  ++line_;
}

/// Sets `pending_` to what the next line says; to nothing at the end.
hal::Status StateDumpReader::read_line() {
  pending_.reset();
  std::string line;
  if (!std::getline(in_, line)) return {};
  ++line_;
  const hal::Error bad{path_ + ":" + std::to_string(line_) + ": error: not a line 'tick,who,what,field,value'"};
  core::StateValue value;
  value.value = cut_last(line);
  value.field = cut_last(line);
  value.what = cut_last(line);
  const std::size_t comma = line.find(',');
  if (comma == std::string::npos || value.value.empty()) return bad;
  DumpedState read;
  const auto [end, error] = std::from_chars(line.data(), line.data() + comma, read.tick);
  if (error != std::errc{} || end != line.data() + comma) return bad;
  value.who = uncell(line.substr(comma + 1));
  read.values.push_back(std::move(value));
  pending_ = std::move(read);
  return {};
}

hal::Result<std::optional<DumpedState>> StateDumpReader::next() {
  if (!pending_) {
    if (const hal::Status read = read_line(); !read.ok()) return read.error();
  }
  if (!pending_) return std::optional<DumpedState>{};
  DumpedState state = std::move(*pending_);
  for (;;) {
    if (const hal::Status read = read_line(); !read.ok()) return read.error();
    if (!pending_ || pending_->tick != state.tick) return std::optional(std::move(state));
    state.values.push_back(std::move(pending_->values.front()));
  }
}

}  // namespace tandem::app
