#include "bridges/peer/controller_copy.hpp"

#include <algorithm>

namespace tandem::bridges::peer {
namespace {

using hal::Json;
using File = ControllerCopy::File;

constexpr std::size_t kDigitsShown = 12;

void add(std::string& text, const std::string& what) {
  text += (text.empty() ? "" : "; ") + what;
}

std::string digest_text(const std::string& sha256) {
  return sha256.size() <= kDigitsShown ? sha256 : sha256.substr(0, kDigitsShown) + "…";
}

/// "libwalk.so with sha256 91be…"
std::string text_of(const File& file) {
  return file.name + " with sha256 " + digest_text(file.sha256);
}

Json to_json(const File& file) {
  return {{"name", file.name}, {"sha256", file.sha256}};
}

File file_from(const Json& json) {
  return {json.value("name", ""), json.value("sha256", "")};
}

void compare_scripts(const std::vector<File>& hubs, const std::vector<File>& peers, CopyComparison& result) {
  const auto named = [](const std::vector<File>& files, const std::string& name) {
    const auto found = std::ranges::find(files, name, &File::name);
    return found == files.end() ? nullptr : &*found;
  };
  for (const File& file : hubs) {
    const File* const other = named(peers, file.name);
    if (other == nullptr)
      add(result.differs, "the peer does not run the script " + file.name + " of the hub");
    else if (other->sha256 != file.sha256)
      add(result.differs, "the peer runs the script " + text_of(*other) + ", the hub " + digest_text(file.sha256));
    else
      add(result.same, text_of(file));
  }
  for (const File& file : peers) {
    if (named(hubs, file.name) == nullptr)
      add(result.differs, "the peer runs the script " + file.name + ", which the hub does not");
  }
}

/// Of two processors: bytes say nothing.
void compare_builds(const ControllerCopy& hubs, const ControllerCopy& peers, CopyComparison& result) {
  add(result.not_compared,
      "the libraries, for the peer's is for " + peers.processor + ", the hub's for " + hubs.processor);
  if (hubs.release != peers.release)
    add(result.differs,
        "the peer's library was built with Tandem " + peers.release + ", the hub's with Tandem " + hubs.release);
  else
    add(result.same, "built with Tandem " + hubs.release);
  for (const auto& [name, number] : hubs.surfaces) {
    const auto other = peers.surfaces.find(name);
    if (other == peers.surfaces.end())
      add(result.differs, "the peer's library does not use the surface " + name + ", the hub's does");
    else if (other->second != number)
      add(result.differs, "the peer's library uses the surface " + name + " " + std::to_string(other->second) +
                              ", the hub's " + std::to_string(number));
  }
  for (const auto& [name, number] : peers.surfaces) {
    if (!hubs.surfaces.contains(name))
      add(result.differs, "the peer's library uses the surface " + name + ", the hub's does not");
  }
  const bool known = !hubs.commit.empty() && !peers.commit.empty();
  const bool clean = hubs.commit.find(' ') == std::string::npos;  // "… with changes"
  if (known && clean && hubs.commit == peers.commit)
    add(result.same, "both programs of commit " + digest_text(hubs.commit));
  else
    add(result.not_compared, known && hubs.commit != peers.commit
                                 ? "their sources, for the programs are of commits " + digest_text(peers.commit) +
                                       " (peer) and " + digest_text(hubs.commit) + " (hub)"
                                 : "their sources, for the programs do not tell one clean commit");
}

void compare_libraries(const ControllerCopy& hubs, const ControllerCopy& peers, CopyComparison& result) {
  if (hubs.library.sha256.empty() || peers.library.sha256.empty())
    return add(result.not_compared, std::string("the libraries, for that of the ") +
                                        (peers.library.sha256.empty() ? "peer" : "hub") + " has no digest");
  if (hubs.library.sha256 == peers.library.sha256) return add(result.same, text_of(hubs.library));
  if (hubs.processor != peers.processor) return compare_builds(hubs, peers, result);
  add(result.differs, "the peer runs " + text_of(peers.library) + ", the hub has " + text_of(hubs.library));
}

}  // namespace

Json to_json(const ControllerCopy& copy) {
  Json json = {{"name", copy.label},          {"library", to_json(copy.library)},
               {"processor", copy.processor}, {"release", copy.release},
               {"commit", copy.commit},       {"scripts", Json::array()},
               {"surfaces", copy.surfaces}};
  for (const File& script : copy.scripts) json["scripts"].push_back(to_json(script));
  return json;
}

ControllerCopy controller_copy_from(const Json& json) {
  ControllerCopy copy;
  copy.label = json.value("name", "");
  copy.library = file_from(json.value("library", Json::object()));
  copy.processor = json.value("processor", "");
  copy.release = json.value("release", "");
  copy.commit = json.value("commit", "");
  for (const Json& script : json.value("scripts", Json::array())) copy.scripts.push_back(file_from(script));
  copy.surfaces = json.value("surfaces", std::map<std::string, std::uint32_t>());
  return copy;
}

CopyComparison compare(const ControllerCopy& hubs, const std::optional<ControllerCopy>& peers) {
  CopyComparison result;
  if (!peers) {
    result.not_compared = "the peer does not tell which controller it runs";
    return result;
  }
  if (peers->label.empty())
    add(result.not_compared, "the controllers' names, for the peer tells none");
  else if (peers->label != hubs.label)
    add(result.differs, "the peer runs the controller '" + peers->label + "', the hub has '" + hubs.label + "'");
  compare_scripts(hubs.scripts, peers->scripts, result);
  compare_libraries(hubs, *peers, result);
  return result;
}

}  // namespace tandem::bridges::peer
