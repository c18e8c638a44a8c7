// Random numbers. All follow from the run's seed: a robot's own ones do not depend on other robots or on threads.
#ifndef TANDEM_ARGOS3_RNG_H
#define TANDEM_ARGOS3_RNG_H
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/range.h>

namespace argos {

class CRandom {
 public:
  /// A generator. CreateRNG makes it; it lives as long as the process.
  class CRNG {
   public:
    CRNG(UInt32 seed);
    CRNG(const CRNG& other);
    CRNG& operator=(const CRNG& other);
    virtual ~CRNG();

    UInt32 GetSeed() const noexcept { return m_unSeed; }
    /// Takes effect with Reset.
    void SetSeed(UInt32 seed) noexcept;
    void Reset();

    /// True with this probability.
    bool Bernoulli(Real probability = 0.5);
    /// In [min, max).
    CRadians Uniform(const CRange<CRadians>& range);
    Real Uniform(const CRange<Real>& range);
    SInt32 Uniform(const CRange<SInt32>& range);
    UInt32 Uniform(const CRange<UInt32>& range);
    Real Exponential(Real mean);
    UInt32 Poisson(Real mean);
    Real Gaussian(Real deviation, Real mean = 0.0);
    Real Rayleigh(Real sigma);
    Real Lognormal(Real sigma, Real mu);
    template <typename T>
    void Shuffle(std::vector<T>& values) {
      for (std::size_t left = values.size(); left > 1; --left)
        std::swap(values[left - 1], values[Uniform(CRange<UInt32>(0, static_cast<UInt32>(left)))]);
    }

   private:
    friend struct TandemRandom;  // who makes them of a robot's seed
    struct SGenerator;
    SGenerator* m_psGenerator;
    UInt32 m_unSeed;
  };

  class CCategory {
   public:
    CCategory(const std::string& id, UInt32 seed);
    virtual ~CCategory();
    CCategory(const CCategory&) = delete;
    CCategory& operator=(const CCategory&) = delete;

    const std::string& GetId() const noexcept { return m_strId; }
    void SetId(const std::string& id) { m_strId = id; }
    UInt32 GetSeed() const noexcept { return m_unSeed; }
    void SetSeed(UInt32 seed) { m_unSeed = seed; }
    CRNG* CreateRNG();
    void ResetRNGs();
    /// Gives all of its generators seeds that follow from its own.
    void ReseedRNGs();

   private:
    std::string m_strId;
    UInt32 m_unSeed;
    std::vector<CRNG*> m_vecRNGList;
  };

  static bool CreateCategory(const std::string& category, UInt32 seed);
  /// @throws CARGoSException when there is none of that name
  static CCategory& GetCategory(const std::string& category);
  static bool ExistsCategory(const std::string& category);
  static void RemoveCategory(const std::string& category);
  /// The category "argos" is always there.
  static CRNG* CreateRNG(const std::string& category);
  static UInt32 GetSeedOf(const std::string& category);
  static void SetSeedOf(const std::string& category, UInt32 seed);
  static void Reset();
};

}  // namespace argos

#endif
