#include "mixed_reality/settings/kind_check.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace tandem::mixed_reality {
namespace {

/// Counts the sensors or lamps of a part.
class Places final : public hal::ParamVisitor {
 public:
  explicit Places(hal::AnyPart part) { part.describe(*this); }

  void visit(const hal::Param& param) override {
    if (param.list() != nullptr && (param.name == "mount" || param.name == "head")) count_ += param.list()->size();
  }
  std::size_t count() const noexcept { return count_; }

 private:
  std::size_t count_ = 0;
};

std::string_view moves(const hal::RobotKind& kind) {
  return kind.drive() != nullptr ? hal::DifferentialDrive::kName
         : kind.flies()          ? hal::Quadrotor::kName
                                 : std::string_view("no drive");
}

}  // namespace

hal::Status check_built_as(const hal::RobotKind* kind, const hal::RobotKind& real) {
  if (kind == nullptr || kind == &real) return {};
  const std::string who = "the kind '" + kind->name + "'";
  if (kind->locomotion.index() != real.locomotion.index())
    return hal::Error{who + " has " + std::string(moves(*kind)) + ", and the bridge to '" + real.name + "' drives a " +
                      std::string(moves(real)) + "; give the kind that, or leave its <bridge> out"};
  std::map<std::string_view, std::size_t> places;
  for (const hal::AnyPart& part : real.parts()) places.emplace(part.name(), Places(part).count());
  for (const hal::AnyPart& part : kind->parts()) {
    const auto there = places.find(part.name());
    const std::size_t count = Places(part).count();
    if (there == places.end() || there->second == count) continue;
    return hal::Error{who + " has " + std::to_string(count) + " in its <" + std::string(part.name()) +
                      ">, where a real '" + real.name + "' has " + std::to_string(there->second) +
                      "; give it as many, or leave the part or its <bridge> out"};
  }
  return {};
}

}  // namespace tandem::mixed_reality
