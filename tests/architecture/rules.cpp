#include "tests/architecture/rules.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

namespace tandem::architecture {
namespace {

namespace fs = std::filesystem;

/// Lower layers come first; a folder may depend on its own layer and on those that this table allows.
const std::map<std::string, std::set<std::string>> kLayers = {
    {"hal", {"hal"}},
    {"controllers", {"controllers", "hal"}},
    {"bridges", {"bridges", "hal"}},
    {"core", {"core", "hal"}},
    {"hooks", {"hooks", "core", "hal"}},
    {"mixed_reality", {"mixed_reality", "core", "bridges", "controllers", "hal"}},
    {"window", {"window", "core", "hal"}},
    {"study", {"study", "core", "hal"}},
    {"app", {"app", "window", "study", "mixed_reality", "core", "bridges", "controllers", "hal"}},
    {"library", {"library", "compat", "app", "core", "hal"}},
    {"python", {"python", "library", "app", "core", "hal"}},
    {"validate", {"validate", "library", "app", "study", "core", "hal"}},
    {"lab", {"lab", "bench", "validate", "app", "hal"}},
    {"compat", {"compat", "core", "hal"}},
    {"linked", {"linked", "lab", "compat", "app", "bridges", "core", "hal"}},
    {"bench", {"bench", "app", "window", "study", "mixed_reality", "core", "bridges", "controllers", "hal"}}};

std::string layer_of(const std::string& folder) {
  return folder.substr(0, folder.find('/'));
}

std::set<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::set<std::string> out;
  for (std::string word; in >> word;) out.insert(word);
  return out;
}

/// The declared folder that `path` belongs to: the longest that it lies in.
std::string folder_of(const std::string& path, const Dependencies& dependencies) {
  std::string best;
  for (const auto& [folder, deps] : dependencies) {
    if (path.starts_with(folder + "/") && folder.size() > best.size()) best = folder;
  }
  return best;
}

/// The part of a declared folder that `path` lies in, a sub-folder without a list of its own; "" for files beside them.
std::string room_of(const std::string& path, const std::string& folder) {
  const std::string rest = path.substr(folder.size() + 1);
  const std::size_t slash = rest.find('/');
  return slash == std::string::npos ? "" : folder + "/" + rest.substr(0, slash);
}

/// Headers that define types of one name in one namespace: a program that links both has the functions of one of them.
/// `space` is the namespace that the lines before opened.
void defined_twice(const std::string& line, const std::string& path, std::string& space,
                   std::map<std::string, std::string>& types, std::vector<std::string>& broken) {
  static const std::regex kNamespace(R"(^namespace ([A-Za-z0-9_:]+) \{)");
  static const std::regex kType(R"(^(?:class|struct|union|enum class|enum) (\w+)(?: final)?(?: : [^;]*)?(?: \{.*)?$)");
  std::smatch match;
  if (std::regex_search(line, match, kNamespace)) space = match[1];
  if (!std::regex_search(line, match, kType)) return;
  const std::string name = space + "::" + match[1].str();
  const auto [first, added] = types.emplace(name, path);
  if (!added && first->second != path)
    broken.push_back(path + ": " + name + " is defined by " + first->second + ", too");
}

/// Takes away, as long as there is one, a room that includes no other that is left. What remains includes in a circle.
Dependencies circles_of(Dependencies rooms) {
  for (bool taken = true; taken;) {
    taken = false;
    for (auto room = rooms.begin(); room != rooms.end(); ++room) {
      const auto& others = room->second;
      if (std::ranges::any_of(others, [&](const std::string& other) { return rooms.contains(other); })) continue;
      rooms.erase(room);
      taken = true;
      break;  // the iterator is gone
    }
  }
  return rooms;
}

}  // namespace

Dependencies read_dependencies(const fs::path& file) {
  Dependencies dependencies;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(" : ");
    if (first == std::string::npos) continue;
    const std::size_t second = line.find(" :", first + 2);
    auto& deps = dependencies[line.substr(0, first)];
    deps.merge(words(line.substr(first + 3, second - first - 3)));
  }
  return dependencies;
}

std::vector<std::string> broken_rules(const fs::path& top, const Dependencies& dependencies,
                                      const LibraryOwners& owners) {
  std::vector<std::string> broken;
  Dependencies rooms;
  for (const auto& [folder, deps] : dependencies) {
    const auto layer = kLayers.find(layer_of(folder));
    if (layer == kLayers.end()) continue;
    for (const std::string& dep : deps) {
      if (!layer->second.contains(layer_of(dep)))
        broken.push_back(folder + "/CMakeLists.txt: " + folder + " may not depend on " + dep);
    }
  }
  std::map<std::string, std::string> types;  // and the header that defines each
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  for (const auto& [layer, allowed] : kLayers) {
    if (!fs::exists(top / layer)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(top / layer)) {
      const std::string path = fs::relative(entry.path(), top).generic_string();
      if (entry.is_directory()) {
        const std::string name = entry.path().filename().string();
        if (name == "common" || name == "utils" || name == "util" || name == "misc")
          broken.push_back(path + ": a folder's name says what is in it");
        continue;
      }
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      const std::string folder = folder_of(path, dependencies);
      if (folder.empty()) {
        broken.push_back(path + ": lies in no declared folder");
        continue;
      }
      std::ifstream in(entry.path());
      int number = 0;
      std::string space;
      for (std::string line; std::getline(in, line);) {
        ++number;
        std::smatch match;
        if (path.ends_with(".hpp")) defined_twice(line, path, space, types, broken);
        if (!std::regex_search(line, match, kInclude)) continue;
        const std::string header = match[2];
        const std::string where = path + ":" + std::to_string(number) + ": ";
        if (match[1] == "\"") {
          const std::string included = folder_of(header, dependencies);
          if (included.empty())
            broken.push_back(where + "\"" + header + "\" is not named from the top of the tree");
          else if (included != folder && !dependencies.at(folder).contains(included))
            broken.push_back(where + folder + " does not declare " + included);
          else if (included == folder) {
            const std::string room = room_of(path, folder), other = room_of(header, folder);
            if (!room.empty() && !other.empty() && room != other) rooms[room].insert(other);
          }
        }
        for (const auto& [prefix, owner] : owners) {
          if (header.starts_with(prefix) && !words(owner).contains(folder))
            broken.push_back(where + "<" + header + "> belongs to " + owner + " alone");
        }
      }
    }
  }
  for (const auto& [room, others] : circles_of(rooms)) {
    for (const std::string& other : others)
      broken.push_back(room + " and " + other + " include one another, in a circle");
  }
  return broken;
}

}  // namespace tandem::architecture
