#include "hal/catalog.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace tandem::hal {
namespace {

/// Files name these with their library.
bool named_with_library(std::string_view category) noexcept {
  return category == "controller" || category == "hook";
}

/// The entry with zeros behind it, up to the size that its type has here.
std::shared_ptr<const void> widened(const CatalogItem& item, std::size_t size) {
  auto memory = std::make_shared<std::vector<std::max_align_t>>(size / sizeof(std::max_align_t) + 1);
  std::memset(memory->data(), 0, size);
  std::memcpy(memory->data(), item.entry, item.size);
  return {memory, memory->data()};
}

/// Checks what one origin registers against what there is.
class Collector final : public Registrar {
 public:
  Collector(const std::string& origin, const Catalog& catalog)
      : surfaces(catalog), origin_(origin), known_(catalog.entries()) {}

  void know(const Surface& surface) override { surfaces.know(surface); }

  void add(const CatalogItem& item) override {
    const auto refuse = [&](const std::string& why) {
      problem("registers the " + std::string(item.category) + " '" + std::string(item.name) + "'" + why);
    };
    if (item.name.empty() || item.category.empty()) return refuse(" without a name");
    if (item.entry == nullptr) return refuse(" without a type");
    if (!item.flaw.empty()) return refuse(", which " + std::string(item.flaw));
    Catalog::Entry entry{std::string(item.category), std::string(item.name), item.layout, item.entry, origin_};
    for (const Surface& surface : surfaces.surfaces()) {
      if (surface.name != item.category) continue;
      if (detail::mixed(surface.digest, surface.number) != item.layout || surface.size < item.size)
        return refuse(", whose type has another form than in " + first_origin(item.category) +
                      ": build both against the same headers");
      if (item.size == 0 || item.size == surface.size) continue;
      entry.widened = widened(item, surface.size);
      entry.entry = entry.widened.get();
    }
    for (const auto* list : std::initializer_list<const std::vector<Catalog::Entry>*>{&known_, &added}) {
      for (const Catalog::Entry& e : *list) {
        if (e.name != item.name || e.category != item.category) continue;
        if (list == &known_ && named_with_library(item.category)) continue;
        return refuse(" a second time: the first is from " + e.origin + "; give one of them another name");
      }
    }
    // A table has one name: the first entry would bear the second's.
    for (const Catalog::Entry& e : added) {
      if (e.entry == item.entry && e.category == item.category)
        return refuse(" with the class that it registers as '" + e.name + "': derive a class for each name");
    }
    added.push_back(std::move(entry));
  }

  Catalog surfaces;  // what it knows with this origin
  std::vector<Catalog::Entry> added;
  std::string problems;

 private:
  /// Of the first entry of a category.
  std::string first_origin(std::string_view category) const {
    for (const auto* list : std::initializer_list<const std::vector<Catalog::Entry>*>{&known_, &added}) {
      for (const Catalog::Entry& e : *list) {
        if (e.category == category) return e.origin;
      }
    }
    return "this program";
  }
  void problem(const std::string& text) { problems += (problems.empty() ? "" : "\n  ") + text; }

  const std::string& origin_;
  const std::vector<Catalog::Entry>& known_;
};

}  // namespace

Status Catalog::add_from(const std::string& origin, const std::function<void(Registrar&)>& fill) {
  Collector collector(origin, *this);
  fill(collector);
  if (!collector.problems.empty()) return Error{"'" + origin + "' " + collector.problems};
  surfaces_ = collector.surfaces.surfaces();
  entries_.insert(entries_.end(), std::make_move_iterator(collector.added.begin()),
                  std::make_move_iterator(collector.added.end()));
  return {};
}

void Catalog::know(const Surface& surface) {
  if (std::none_of(surfaces_.begin(), surfaces_.end(), [&](const Surface& s) { return s.name == surface.name; }))
    surfaces_.push_back(surface);
}

std::vector<std::string> Catalog::names(std::string_view category) const {
  std::vector<std::string> names;
  for (const Entry& e : entries_) {
    if (e.category == category) names.push_back(e.name);
  }
  return names;
}

void Catalog::know_elsewhere(std::string_view category, std::string_view name) {
  elsewhere_.emplace_back(category, name);
}

std::vector<std::string> Catalog::elsewhere(std::string_view category) const {
  const std::vector<std::string> here = names(category);
  std::vector<std::string> names;
  for (const auto& [of, name] : elsewhere_) {
    if (of == category && std::find(here.begin(), here.end(), name) == here.end()) names.push_back(name);
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
