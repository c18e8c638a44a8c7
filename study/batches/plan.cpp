#include "study/batches/plan.hpp"

#include <algorithm>
#include <filesystem>

#include "hal/input_file.hpp"
#include "hal/json/json.hpp"
#include "hal/output_file.hpp"

namespace tandem::study {
namespace {

constexpr int kFormat = 1;

std::string file_in(const std::string& folder) {
  return (std::filesystem::path(folder) / "plan.json").string();
}

}  // namespace

std::vector<std::vector<std::int64_t>> share_out(const std::vector<std::int64_t>& runs, std::int64_t configurations,
                                                 std::size_t each, std::size_t most) {
  std::vector<std::int64_t> sorted = runs;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](std::int64_t a, std::int64_t b) { return a % configurations < b % configurations; });
  const std::size_t wanted = (sorted.size() + std::max<std::size_t>(1, each) - 1) / std::max<std::size_t>(1, each);
  const std::size_t count = std::min(wanted, most);
  std::vector<std::vector<std::int64_t>> batches(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t n) {
      return sorted.begin() + static_cast<std::ptrdiff_t>(n * sorted.size() / count);
    };
    batches[i].assign(at(i), at(i + 1));
  }
  return batches;
}

hal::Status write_plan(const std::string& folder, const BatchPlan& plan) {
  hal::Json json;
  json["format"] = kFormat;
  json["program"] = plan.version.program;
  json["files"] = hal::Json::array();
  for (const auto& [name, digest] : plan.version.files) json["files"].push_back({name, digest});
  json["batches"] = plan.batches;
  return hal::write_whole_file(file_in(folder), "plan of the batches", hal::to_text(json) + "\n");
}

hal::Result<BatchPlan> read_plan(const std::string& folder) {
  const std::string path = file_in(folder);
  const auto text = hal::read_whole_file(path, "plan");
  if (!text.ok()) return hal::Error{text.error().message + "; it is written by `tandem sweep … --slurm`"};
  auto json = hal::parse_json_object(text.value());
  if (!json.ok()) return hal::Error{"'" + path + "': " + json.error().message};
  try {
    if (json->at("format").get<int>() != kFormat)
      return hal::Error{"'" + path + "' was written by another release of this program"};
    BatchPlan plan;
    plan.version.program = json->at("program").get<std::string>();
    for (const hal::Json& file : json->at("files"))
      plan.version.files.emplace_back(file.at(0).get<std::string>(), file.at(1).get<std::string>());
    plan.batches = json->at("batches").get<decltype(plan.batches)>();
    return plan;
  } catch (const hal::JsonError& problem) {
    return hal::Error{"'" + path + "' is no plan of batches: " + problem.what()};
  }
}

}  // namespace tandem::study
