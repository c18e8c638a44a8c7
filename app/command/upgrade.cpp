// `tandem upgrade`: brings an experiment file to this program's version of the vocabulary.
#include "core/config/upgrade.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/terminal.hpp"
#include "hal/output_file.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::app {

int upgrade(const UpgradeOptions& options) {
  const std::string& path = options.experiment;
  core::Problems problems;
  if (!hal::read_xml_file(path, problems)) {  // judges what kind of file it is, too
    print_problems(problems);
    return kBadInput;
  }
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) return complain(kBadInput, path + ": the file cannot be read: " + std::strerror(errno));
  const auto made = core::upgraded(text, path, catalog());
  if (!made.ok()) return complain(kBadInput, made.error().message);
  if (made.value().changes.empty()) {
    fmt::print("{}: up to date\n", path);
    return kDone;
  }
  if (!options.dry_run) {
    const hal::Status written = hal::write_whole_file(path, "experiment", made.value().text);
    if (!written.ok()) return complain(kFailedRunning, written.error().message);
  }
  for (const std::string& change : made.value().changes) fmt::print("{}: {}\n", path, change);
  fmt::print("{}: {} to version {}\n", path, options.dry_run ? "would be brought" : "brought", core::kFileVersion);
  return kDone;
}

}  // namespace tandem::app
