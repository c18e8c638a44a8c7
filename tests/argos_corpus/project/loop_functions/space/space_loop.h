/*
 * Counts, finds, adds, moves and removes entities, asks their components, anchors, boxes, contacts and rays.
 */
#ifndef CORPUS_SPACE_LOOP_H
#define CORPUS_SPACE_LOOP_H

#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/simulator/loop_functions.h>

using namespace argos;

class CSpaceLoop : public CLoopFunctions {
public:
   virtual void Init(TConfigurationNode& t_tree);
   virtual void Reset();
   virtual void PreStep();
   virtual void PostStep();

private:
   size_t Count(const std::string& str_type);
   void Find();
   void Components();
   void Add();
   void Move();
   void Remove();
   void Rays();
   void Contacts();
};

#endif
