// The copy of a controller that one side of a run in lock-step has, and how it compares with the other side's.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hal/json/json.hpp"

namespace tandem::bridges::peer {

/// What a copy tells of itself; what is empty is not told.
struct ControllerCopy {
  struct File {
    std::string name;    ///< without its folder, or as the experiment writes it: the same on every machine
    std::string sha256;  ///< in hexadecimal digits

    bool operator==(const File&) const = default;
  };

  std::string label;                              ///< registered name of the controller
  File library;                                   ///< the shared object
  std::string processor;                          ///< that it was compiled for
  std::string release;                            ///< of Tandem that it was compiled with: "0.1.0"
  std::string commit;                             ///< of the program that runs it
  std::vector<File> scripts;                      ///< that it runs
  std::map<std::string, std::uint32_t> surfaces;  ///< numbers of the surfaces that the library uses, by name

  bool operator==(const ControllerCopy&) const = default;
};

hal::Json to_json(const ControllerCopy& copy);
/// @throws hal::JsonError: a member of another type
ControllerCopy controller_copy_from(const hal::Json& json);

/// Of two copies, for people; parts that there are none of are empty.
struct CopyComparison {
  std::string differs;       ///< what is not the same, here and there: the controllers are not the same
  std::string same;          ///< what is
  std::string not_compared;  ///< the unknown part, and why
};

/// `peers`: nothing: the peer does not tell. Files are compared by their digests; libraries for two different
/// processors by what they were compiled with.
CopyComparison compare(const ControllerCopy& hubs, const std::optional<ControllerCopy>& peers);

}  // namespace tandem::bridges::peer
