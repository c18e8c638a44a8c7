// The memory of a physics library as words, and which of them are addresses of what: so it can be read elsewhere.
//
// Addresses of anything but itself and loaded objects are null in another process: of what a library keeps elsewhere
// and makes anew where there is none (ODE its working memory), and what happened to lie between values.
#include <algorithm>
#include <cstring>
#include <optional>
#include <random>
#include <string>

#include "core/physics/world_memory.hpp"
#include "core/space/addresses.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);

/// A word that is an address.
struct AddressWord {
  std::uint32_t chunk, of_chunk;  ///< the word's, and that into which it points; kObject and above: a loaded object
  std::uint64_t word;             ///< in its chunk
  static constexpr std::uint32_t kObject = 0x8000'0000U, kElsewhere = 0xFFFF'FFFFU;
};

/// Tells this process from others.
std::uint64_t process_token() {
  static const std::uint64_t token = [] {
    std::random_device device;
    return std::uint64_t{device()} << 32 | device();
  }();
  return token;
}

}  // namespace

WorldMemory::Place WorldMemory::place_of(std::uint64_t address) const noexcept {
  for (std::uint32_t i = 0; i < chunks(); ++i) {
    const std::uint64_t offset = address - reinterpret_cast<std::uintptr_t>(chunk(i).bytes.get());
    if (offset < chunk(i).size) return {i, offset};
  }
  return {};
}

std::uint64_t WorldMemory::address_of(const Place& place) const noexcept {
  if (place.chunk >= chunks() || place.offset >= chunk(place.chunk).size) return 0;
  return reinterpret_cast<std::uintptr_t>(chunk(place.chunk).bytes.get()) + place.offset;
}

void WorldMemory::remember_address(hal::Archive& archive, void*& address) const {
  Place place = place_of(reinterpret_cast<std::uintptr_t>(address));
  archive(place.chunk, place.offset);
  if (archive.reads()) address = reinterpret_cast<void*>(address_of(place));
}

bool WorldMemory::remember_all(hal::Archive& archive, std::initializer_list<void**> pointers) {
  if (archive.reads()) {
    clear();
    shared_.clear();
    large_.clear();
  }
  for (auto* chunks : {&shared_, &large_}) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> sizes;
    for (const Chunk& chunk : *chunks) sizes.emplace_back(chunk.size, chunk.used);
    archive(sizes);
    if (!archive.reads()) continue;
    for (const auto& [size, used] : sizes)
      chunks->push_back({size > 0 ? room(size) : Room(), size, std::min(used, size)});
  }
  archive(filling_, blocks_);
  for (void*& head : unused_) remember_address(archive, head);
  for (void** pointer : pointers) remember_address(archive, *pointer);
  if (archive.reads()) return read_words(archive);
  write_words(archive);
  return true;
}

/// The words of all chunks as far as they are used; of blocks that were freed what links them alone.
std::vector<std::vector<std::uint64_t>> WorldMemory::live_words() const {
  std::vector<std::vector<std::uint64_t>> all;
  for (std::size_t i = 0; i < chunks(); ++i) {
    all.emplace_back((chunk(i).used + kWord - 1) / kWord);
    if (chunk(i).used > 0) std::memcpy(all.back().data(), chunk(i).bytes.get(), chunk(i).used);
  }
  for (std::size_t size_class = 0; size_class < kClasses; ++size_class) {
    for (const void* block = unused_[size_class]; block != nullptr; std::memcpy(&block, block, sizeof block)) {
      const Place place = place_of(reinterpret_cast<std::uintptr_t>(block));
      const auto first = all[place.chunk].begin() + static_cast<std::ptrdiff_t>(place.offset / kWord);
      std::fill(first + 1, first + static_cast<std::ptrdiff_t>(size_of_class(size_class) / kWord), 0);
    }
  }
  return all;
}

void WorldMemory::write_words(hal::Archive& archive) const {
  std::optional<Addresses> addresses;
  const std::vector<LoadedObject> objects = loaded_objects();
  std::vector<AddressWord> found;
  std::vector<std::uint32_t> named;  // of the objects
  std::vector<std::string> names;
  auto words = live_words();
  for (std::uint32_t c = 0; c < words.size(); ++c) {
    for (std::size_t k = 0; k < words[c].size(); ++k) {
      std::uint64_t& word = words[c][k];
      if (word < Addresses::kLeast || word > Addresses::kMost) continue;
      if (const Place place = place_of(word); place.chunk != Place::kNone) {
        found.push_back({c, place.chunk, k});
        word = place.offset;
        continue;
      }
      const auto object =
          std::ranges::find_if(objects, [word](const LoadedObject& o) { return word >= o.begin && word < o.past; });
      if (object == objects.end()) {
        if (!addresses) addresses.emplace();
        if (addresses->may_be(word)) found.push_back({c, AddressWord::kElsewhere, k});
        continue;
      }
      const auto number = static_cast<std::uint32_t>(object - objects.begin());
      const auto known = std::ranges::find(named, number);
      found.push_back({c, AddressWord::kObject + static_cast<std::uint32_t>(known - named.begin()), k});
      if (known == named.end()) {
        named.push_back(number);
        names.push_back(object->identity);
      }
      word -= object->begin;
    }
  }
  std::uint64_t token = process_token();
  archive(token, words, names, found);
}

bool WorldMemory::read_words(hal::Archive& archive) {
  std::vector<std::vector<std::uint64_t>> words;
  std::vector<std::string> names;
  std::vector<AddressWord> found;
  std::uint64_t token = 0;
  archive(token, words, names, found);
  if (!archive.ok() || words.size() != chunks()) return false;
  std::vector<std::uint64_t> begins;
  const std::vector<LoadedObject> objects = loaded_objects();
  for (const std::string& name : names) {
    const auto object = std::ranges::find(objects, name, &LoadedObject::identity);
    if (object == objects.end()) return false;
    begins.push_back(object->begin);
  }
  for (const AddressWord& at : found) {
    if (at.chunk >= words.size() || at.word >= words[at.chunk].size()) return false;
    std::uint64_t& word = words[at.chunk][at.word];
    const std::uint32_t object = at.of_chunk - AddressWord::kObject;
    if (at.of_chunk == AddressWord::kElsewhere)
      word = token == process_token() ? word : 0;
    else if (at.of_chunk < AddressWord::kObject)
      word = address_of({at.of_chunk, word});
    else if (object < begins.size())
      word += begins[object];
    else
      return false;
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].size() * kWord < chunk(i).used) return false;
    if (chunk(i).used > 0) std::memcpy(chunk(i).bytes.get(), words[i].data(), chunk(i).used);
  }
  return true;
}

}  // namespace tandem::core
