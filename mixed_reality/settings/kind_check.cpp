#include "mixed_reality/settings/kind_check.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace tandem::mixed_reality {
namespace {

/// Counts the sensors or lamps of a part.
class Places final : public hal::ParamVisitor {
 public:
  explicit Places(hal::AnyPart part) { part.describe(*this); }

  void number(std::string_view, double&, const hal::Unit&, hal::Range, std::string_view) override {}
  void integer(std::string_view, std::int64_t&, hal::Range, std::string_view) override {}
  void flag(std::string_view, bool&, std::string_view) override {}
  void text(std::string_view, std::string&, std::string_view) override {}
  void choice(std::string_view, std::string&, std::span<const std::string_view>, std::string_view) override {}
  void vector(std::string_view, std::array<double, 3>&, const hal::Unit&, std::string_view) override {}

  std::size_t count() const noexcept { return count_; }

 protected:
  void visit_group(std::string_view, void*, Describe, std::string_view) override {}
  void visit_list(std::string_view name, hal::ParamList& list, std::string_view) override {
    if (name == "mount" || name == "head") count_ += list.size();
  }

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
