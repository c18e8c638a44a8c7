// The rules of the tree, checked against the lists that the build itself uses.
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tandem::architecture {

/// Folders, and the folders whose headers each may include.
using Dependencies = std::map<std::string, std::set<std::string>>;

/// Reads lines "folder : dependencies : libraries", as the build writes them.
Dependencies read_dependencies(const std::filesystem::path& file);

/// Third-party headers by their beginning, and the only folders that may include each, separated by spaces.
using LibraryOwners = std::map<std::string, std::string>;

/// Every broken rule as "file:line: why": an include of a folder that is not declared, a library's header outside of
/// its folder, a dependency against the layers, a circle among the sub-folders of one, a folder with a name that says
/// nothing, two headers that define types of one name.
std::vector<std::string> broken_rules(const std::filesystem::path& top, const Dependencies& dependencies,
                                      const LibraryOwners& owners);

}  // namespace tandem::architecture
