/*
 * Vectors, angles, ranges, colors, bytes and random numbers; it needs no robot.
 */
#ifndef CORPUS_SUMS_LOOP_H
#define CORPUS_SUMS_LOOP_H

#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/utility/math/rng.h>

using namespace argos;

class CSumsLoop : public CLoopFunctions {
public:
   CSumsLoop() : m_pcRNG(NULL) {}
   virtual void Init(TConfigurationNode& t_tree);

private:
   void Vectors();
   void Angles();
   void Quaternions();
   void Ranges();
   void Numbers();
   void Colors();
   void Bytes();
   void Texts();
   void Chance();
   void ChanceOfMany();
   CRandom::CRNG* m_pcRNG;
};

#endif
