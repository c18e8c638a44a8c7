// CRandom, on hal::Random.
#include <argos3/core/utility/math/rng.h>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>
#include <numbers>

#include "compat/argos3/facade/context.hpp"
#include "hal/elementary.hpp"
#include "hal/poisson.hpp"

namespace argos {

struct CRandom::CRNG::SGenerator {
  std::uint64_t key;
  std::uint32_t stream;
  tandem::hal::Random random;
  std::string owner = {};  ///< the robot, or empty
  SGenerator(std::uint64_t k, std::uint32_t s) : key(k), stream(s), random(k, s) {}
};

/// Makes generators of numbers that users do not have.
struct TandemRandom {
  /// What a key is shown as, and is made of.
  static UInt32 shown(std::uint64_t key) { return static_cast<UInt32>(key ^ key >> 32); }
  static void begin(CRandom::CRNG& rng, std::uint64_t key, std::uint32_t stream) {
    CRandom::CRNG::SGenerator& generator = *rng.m_psGenerator;
    generator.key = key;
    generator.stream = stream;
    generator.random = tandem::hal::Random(key, stream);
    rng.m_unSeed = shown(key);
  }
  /// With a category's seed; a robot's follows from its name, too.
  static void begin_of(CRandom::CRNG& rng, std::uint64_t category_seed) {
    const std::string& owner = rng.m_psGenerator->owner;
    begin(rng, owner.empty() ? category_seed : tandem::hal::seed_of(category_seed, owner), rng.m_psGenerator->stream);
  }
  static void own(CRandom::CRNG& rng, std::string_view owner, std::size_t stream) {
    rng.m_psGenerator->owner = owner;
    rng.m_psGenerator->stream = static_cast<std::uint32_t>(stream);
  }
  static std::uint32_t stream_of(const CRandom::CRNG& rng) { return rng.m_psGenerator->stream; }
};

}  // namespace argos

namespace tandem::compat::argos3 {
namespace {

using argos::CRandom;

/// All generators and categories of the process; what users hold stays valid.
struct Registry {
  std::mutex mutex;
  std::deque<CRandom::CRNG> generators;
  std::map<std::string, std::unique_ptr<CRandom::CCategory>> categories;
  argos::UInt32 run_seed = 0;  // as it is shown

  Registry() { categories["argos"] = std::make_unique<CRandom::CCategory>("argos", 0); }
  CRandom::CRNG& add() {
    const std::lock_guard lock(mutex);
    return generators.emplace_back(0);
  }
};
Registry& registry() {
  static Registry* const all = new Registry;  // outlives static objects of libraries
  return *all;
}

}  // namespace

void Context::set_seed(std::uint64_t seed, std::string_view name) {
  seed_ = seed;
  name_ = name;
  for (const Taken& one : taken_) {
    if (one.of_run)
      argos::TandemRandom::begin(*one.generator, seed_, argos::TandemRandom::stream_of(*one.generator));
    else
      one.generator->Reset();
  }
}

void Context::take(CRandom::CRNG& generator, const CRandom::CCategory& category) {
  const bool of_run = category.GetId() == "argos";
  argos::TandemRandom::own(generator, name_, taken_.size());
  if (of_run)
    argos::TandemRandom::begin(generator, seed_, argos::TandemRandom::stream_of(generator));
  else
    argos::TandemRandom::begin_of(generator, category.GetSeed());
  taken_.push_back({&generator, of_run});
}

void set_run_seed(std::uint64_t seed) {
  const std::lock_guard lock(registry().mutex);
  registry().run_seed = argos::TandemRandom::shown(seed);
  registry().categories.at("argos")->SetSeed(registry().run_seed);
}

}  // namespace tandem::compat::argos3

namespace argos {

namespace compat = tandem::compat::argos3;

CRandom::CRNG::CRNG(UInt32 seed) : m_psGenerator(new SGenerator(seed, 0)), m_unSeed(seed) {}

CRandom::CRNG::CRNG(const CRNG& other)
    : m_psGenerator(new SGenerator(*other.m_psGenerator)), m_unSeed(other.m_unSeed) {}

CRandom::CRNG& CRandom::CRNG::operator=(const CRNG& other) {
  *m_psGenerator = *other.m_psGenerator;
  m_unSeed = other.m_unSeed;
  return *this;
}

CRandom::CRNG::~CRNG() {
  delete m_psGenerator;
}

void CRandom::CRNG::SetSeed(UInt32 seed) noexcept {
  m_unSeed = seed;
  m_psGenerator->key = seed;
}

void CRandom::CRNG::Reset() {
  m_psGenerator->random = tandem::hal::Random(m_psGenerator->key, m_psGenerator->stream);
}

bool CRandom::CRNG::Bernoulli(Real probability) {
  return m_psGenerator->random.chance(probability);
}

CRadians CRandom::CRNG::Uniform(const CRange<CRadians>& range) {
  return CRadians(m_psGenerator->random.uniform(range.GetMin().GetValue(), range.GetMax().GetValue()));
}

Real CRandom::CRNG::Uniform(const CRange<Real>& range) {
  return m_psGenerator->random.uniform(range.GetMin(), range.GetMax());
}

SInt32 CRandom::CRNG::Uniform(const CRange<SInt32>& range) {
  return static_cast<SInt32>(m_psGenerator->random.integer(range.GetMin(), std::int64_t{range.GetMax()} - 1));
}

UInt32 CRandom::CRNG::Uniform(const CRange<UInt32>& range) {
  return static_cast<UInt32>(m_psGenerator->random.integer(range.GetMin(), std::int64_t{range.GetMax()} - 1));
}

Real CRandom::CRNG::Exponential(Real mean) {
  return m_psGenerator->random.exponential(mean);
}

UInt32 CRandom::CRNG::Poisson(Real mean) {
  return static_cast<UInt32>(tandem::hal::poisson(m_psGenerator->random, mean));
}

Real CRandom::CRNG::Gaussian(Real deviation, Real mean) {
  return m_psGenerator->random.normal(mean, deviation);
}

Real CRandom::CRNG::Rayleigh(Real sigma) {
  return sigma * std::sqrt(2.0 * m_psGenerator->random.exponential());
}

Real CRandom::CRNG::Lognormal(Real sigma, Real mu) {
  return tandem::hal::exp(m_psGenerator->random.normal(mu, sigma));
}

CRandom::CCategory::CCategory(const std::string& id, UInt32 seed) : m_strId(id), m_unSeed(seed) {}

CRandom::CCategory::~CCategory() {}

CRandom::CRNG* CRandom::CCategory::CreateRNG() {
  CRNG& rng = compat::registry().add();
  if (compat::Context* const context = compat::current_context(); context != nullptr)
    context->take(rng, *this);
  else
    TandemRandom::begin(rng, m_unSeed, static_cast<std::uint32_t>(m_vecRNGList.size()));
  const std::lock_guard lock(compat::registry().mutex);
  m_vecRNGList.push_back(&rng);
  return &rng;
}

void CRandom::CCategory::ResetRNGs() {
  for (CRNG* const rng : m_vecRNGList) rng->Reset();
}

void CRandom::CCategory::ReseedRNGs() {
  // With the run's seed each has a key of its context's.
  if (m_strId == "argos" && m_unSeed == compat::registry().run_seed) return ResetRNGs();
  for (CRNG* const rng : m_vecRNGList) TandemRandom::begin_of(*rng, m_unSeed);
}

bool CRandom::CreateCategory(const std::string& category, UInt32 seed) {
  const std::lock_guard lock(compat::registry().mutex);
  const auto [at, is_new] = compat::registry().categories.emplace(category, nullptr);
  if (is_new) at->second = std::make_unique<CCategory>(category, seed);
  return is_new;
}

CRandom::CCategory& CRandom::GetCategory(const std::string& category) {
  const std::lock_guard lock(compat::registry().mutex);
  const auto found = compat::registry().categories.find(category);
  if (found == compat::registry().categories.end())
    THROW_ARGOSEXCEPTION("there is no category '" << category
                                                  << "' of random numbers: CRandom::CreateCategory makes one")
  return *found->second;
}

bool CRandom::ExistsCategory(const std::string& category) {
  const std::lock_guard lock(compat::registry().mutex);
  return compat::registry().categories.contains(category);
}

void CRandom::RemoveCategory(const std::string& category) {
  const std::lock_guard lock(compat::registry().mutex);
  if (compat::registry().categories.erase(category) == 0)
    THROW_ARGOSEXCEPTION("there is no category '" << category << "' of random numbers")
}

CRandom::CRNG* CRandom::CreateRNG(const std::string& category) {
  return GetCategory(category).CreateRNG();
}

UInt32 CRandom::GetSeedOf(const std::string& category) {
  return GetCategory(category).GetSeed();
}

void CRandom::SetSeedOf(const std::string& category, UInt32 seed) {
  GetCategory(category).SetSeed(seed);
}

void CRandom::Reset() {
  const std::lock_guard lock(compat::registry().mutex);
  for (auto& [name, category] : compat::registry().categories) {
    category->ReseedRNGs();
  }
}

}  // namespace argos
