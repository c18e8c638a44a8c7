#include "hal/catalog.hpp"

#include <algorithm>

namespace tandem::hal {
namespace {

/// Files name these with their library.
bool named_with_library(std::string_view category) noexcept {
  return category == "controller" || category == "hook";
}

/// Checks what one origin registers against what there is.
class Collector final : public Registrar {
 public:
  Collector(const std::string& origin, const std::vector<Catalog::Entry>& known) : origin_(origin), known_(known) {}

  void add(const CatalogItem& item) override {
    const std::string what = "registers the " + std::string(item.category) + " '" + std::string(item.name) + "'";
    if (item.name.empty() || item.category.empty()) return problem(what + " without a name");
    if (item.entry == nullptr) return problem(what + " without a type");
    for (const auto* list : std::initializer_list<const std::vector<Catalog::Entry>*>{&known_, &added}) {
      for (const Catalog::Entry& e : *list) {
        if (e.category != item.category) continue;
        if (e.layout != item.layout)
          return problem(what + ", whose type has another form than in " + e.origin +
                         ": build both against the same headers");
        if (e.name != item.name || (list == &known_ && named_with_library(item.category))) continue;
        return problem(what + " a second time: the first is from " + e.origin + "; give one of them another name");
      }
    }
    added.push_back({std::string(item.category), std::string(item.name), item.layout, item.entry, origin_});
  }

  std::vector<Catalog::Entry> added;
  std::string problems;

 private:
  void problem(const std::string& text) { problems += (problems.empty() ? "" : "\n  ") + text; }

  const std::string& origin_;
  const std::vector<Catalog::Entry>& known_;
};

}  // namespace

Status Catalog::add_from(const std::string& origin, const std::function<void(Registrar&)>& fill) {
  Collector collector(origin, entries_);
  fill(collector);
  if (!collector.problems.empty()) return Error{"'" + origin + "' " + collector.problems};
  entries_.insert(entries_.end(), std::make_move_iterator(collector.added.begin()),
                  std::make_move_iterator(collector.added.end()));
  return {};
}

std::vector<std::string> Catalog::names(std::string_view category) const {
  std::vector<std::string> names;
  for (const Entry& e : entries_) {
    if (e.category == category) names.push_back(e.name);
  }
  return names;
}

std::string Catalog::origin_of(const void* entry) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.entry == entry; });
  return found == entries_.end() ? "" : found->origin;
}

const void* Catalog::find(std::string_view category, std::uint64_t layout, std::string_view name) const noexcept {
  for (const Entry& e : entries_) {
    if (e.name == name && e.category == category && e.layout == layout) return e.entry;
  }
  return nullptr;
}

}  // namespace tandem::hal
