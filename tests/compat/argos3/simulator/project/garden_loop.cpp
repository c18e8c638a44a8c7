// Adds, moves, resizes, removes, and asks for what is not there.
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/plugins/robots/e-puck/simulator/epuck_entity.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <argos3/plugins/simulator/entities/box_entity.h>
#include <argos3/plugins/simulator/entities/cylinder_entity.h>
#include <argos3/plugins/simulator/entities/light_entity.h>

#include "walker.h"

class CGardenLoop : public CLoopFunctions {
 public:
  virtual void Init(TConfigurationNode&) {
    LOG << "arena " << GetSpace().GetArenaSize() << " at " << GetSpace().GetArenaCenter() << " from "
        << GetSpace().GetArenaLimits().GetMin() << std::endl;
    for (UInt32 i = 0; i < 3; ++i) {  // all at the origin: each is moved then
      CFootBotEntity* pcRobot = new CFootBotEntity("new" + ToString(i), "walk", CVector3(), CQuaternion());
      AddEntity(*pcRobot);
      Expect(MoveEntity(pcRobot->GetEmbodiedEntity(), CVector3(-1.0 + i, 1.5, 0), CQuaternion()), "moved away");
      Expect(dynamic_cast<CWalker*>(&pcRobot->GetControllableEntity().GetController()) != nullptr, "its controller");
    }
    CBoxEntity* pcBox = new CBoxEntity("stone", CVector3(1, -1, 0), CQuaternion(), false, CVector3(0.4, 0.2, 0.3));
    AddEntity(*pcBox);
    AddEntity(*new CCylinderEntity("pole", CVector3(-1, -1, 0), CQuaternion(), false, 0.1, 0.5));
    AddEntity(*new CLightEntity("lamp", CVector3(0, 0, 1), CColor::YELLOW, 2.0));
    CEmbodiedEntity& cBody = Robot("new0").GetEmbodiedEntity();
    Expect(!MoveEntity(cBody, CVector3(1, -1, 0), CQuaternion(), true), "no room on the stone");
    Expect(!MoveEntity(cBody, CVector3(100, 0, 0), CQuaternion()), "no room outside");
    Expect(MoveEntity(cBody, CVector3(0, -1, 0), CQuaternion(), true), "room, and only looked");
    Expect(Abs(cBody.GetOriginAnchor().Position.GetY() - 1.5) < 1e-9, "still there");
    Expect(!cBody.IsCollidingWithSomething(), "touches nothing");
    Expect(Abs(pcBox->GetEmbodiedEntity().GetBoundingBox().MaxCorner.GetX() - 1.2) < 1e-9, "bounding box");
    pcBox->Resize(CVector3(0.8, 0.2, 0.3));
    Expect(Abs(pcBox->GetEmbodiedEntity().GetBoundingBox().MaxCorner.GetX() - 1.4) < 1e-9, "larger");
    SEmbodiedEntityIntersectionItem sHit;
    Expect(GetClosestEmbodiedEntityIntersectedByRay(sHit, CRay3(CVector3(1, 0, 0.1), CVector3(1, -2, 0.1))), "a hit");
    Expect(&sHit.IntersectedEntity->GetParent() == pcBox && Abs(sHit.TOnRay - 0.45) < 1e-9, "the stone");
    Expect(!GetClosestEmbodiedEntityIntersectedByRay(sHit, CRay3(CVector3(1, 0, 0.4), CVector3(1, -2, 0.4))), "above");
    Refused([this] { AddEntity(*new CLightEntity("stone", CVector3(), CColor::RED, 1.0)); }, "an id twice");
    Refused([this] { AddEntity(*new CFootBotEntity("lost", "nobody")); }, "an unknown controller");
    Refused([this] { AddEntity(*new CFootBotEntity("far", "walk", CVector3(50, 0, 0))); }, "outside");
    Refused([this] { GetSpace().GetEntity("nothing"); }, "GetEntity");
    Refused([this] { GetSpace().GetEntitiesByType("unicorn"); }, "GetEntitiesByType");
    Refused([this] { any_cast<CEPuckEntity*>(GetSpace().GetEntitiesByType("foot-bot").begin()->second); }, "any_cast");
    Refused([this] { Robot("new0").GetComponent<CBoxEntity>("body"); }, "GetComponent of another class");
    Refused([this] { Robot("new0").GetComponent("wings"); }, "GetComponent");
    Expect(Robot("new0").HasComponent("body") && !Robot("new0").HasComponent("wings"), "HasComponent");
    Expect(&Robot("new0").GetComponent<CEmbodiedEntity>("body") == &cBody, "GetComponent");
    Expect(GetSpace().GetEntitiesByType("controller").size() == 4, "controllers");
    Expect(any_cast<CControllableEntity*>(GetSpace().GetEntitiesByType("controller")["new1.controller_0"]) ==
               &Robot("new1").GetControllableEntity(),
           "a controller by its id");
  }
  virtual void PreStep() {
    const UInt32 unClock = GetSpace().GetSimulationClock();
    if (unClock == 2) {
      CVector3 cTo(0, -1.5, 0);
      Expect(MoveEntity(Robot("new0").GetEmbodiedEntity(), cTo, CQuaternion()), "moved in PreStep");
    }
    if (unClock == 3) {
      CSpace::TMapPerType& tRobots = GetSpace().GetEntitiesByType("foot-bot");
      UInt32 unVisited = 0;
      for (CSpace::TMapPerType::iterator it = tRobots.begin(); it != tRobots.end(); ++it) {
        CFootBotEntity* pcRobot = any_cast<CFootBotEntity*>(it->second);
        if (pcRobot->GetId() == "new1") RemoveEntity(*pcRobot);  // the one that is looked at
        ++unVisited;
      }
      Expect(unVisited == 4, "all were visited");
      Expect(GetSpace().GetEntitiesByType("foot-bot").size() == 3, "one less");
      Refused([this] { RemoveEntity("new1"); }, "to remove it twice");
      RemoveEntity("stone");
      AddEntity(*new CBoxEntity("stone", CVector3(1, 1, 0), CQuaternion(), false, CVector3(0.1, 0.1, 0.1)));
      Robot("new2").Disable();
    }
    if (unClock == 4) AddEntity(*new CFootBotEntity("new1", "walk", CVector3(0, 1.5, 0)));  // again
    if (unClock == 6) {
      CRABEquippedEntity& cBoard = Robot("fb").GetRABEquippedEntity();
      Expect(cBoard.GetData() == Message(10, 7), "what its controller sent");
      cBoard.ClearData();
      Expect(cBoard.GetData() == Message(10, 0), "zeros");
    }
    if (unClock == 8) Robot("fb").GetRABEquippedEntity().SetData(CByteArray(3, 9));
  }
  virtual void PostStep() {
    const UInt32 unClock = GetSpace().GetSimulationClock();
    if (unClock == 6 || unClock == 8)
      Expect(Robot("fb").GetRABEquippedEntity().GetData() == Message(10, 7), "its controller sends again");
    if (unClock == 9) {
      const CCI_RangeAndBearingSensor::TReadings& tHeard = Walker("new0").m_tHeard;
      Expect(tHeard.size() == 1 && tHeard[0].Data == Message(10, 7), "hears all of the message of \"fb\"");
    }
    if (unClock == 2) Expect(Abs(Walker("new0").m_cSeen.GetY() + 1.5) < 1e-9, "it saw itself moved in the same tick");
    if (unClock == 4) {
      Expect(Walker("new1").m_unSteps == 1, "it stepped in the tick in which it came");
      Expect(Walker("new2").m_unSteps == 2, "it is disabled");
      Robot("new2").Enable();
    }
    if (unClock == 5) Expect(Walker("new2").m_unSteps == 3, "it is enabled");
  }
  virtual void PostExperiment() { LOG << "checks " << m_unChecks << ", wrong " << m_unWrong << std::endl; }

 private:
  static CByteArray Message(UInt32 un_size, UInt8 un_first) {
    CByteArray cMessage(un_size);
    cMessage[0] = un_first;
    return cMessage;
  }
  CFootBotEntity& Robot(const std::string& str_id) {
    return dynamic_cast<CFootBotEntity&>(GetSpace().GetEntity(str_id));
  }
  CWalker& Walker(const std::string& str_id) {
    return dynamic_cast<CWalker&>(Robot(str_id).GetControllableEntity().GetController());
  }
  void Expect(bool b_holds, const std::string& str_what) {
    ++m_unChecks;
    if (b_holds) return;
    ++m_unWrong;
    LOGERR << "WRONG: " << str_what << std::endl;
  }
  template <typename CALL>
  void Refused(CALL t_call, const std::string& str_what) {
    try {
      t_call();
      Expect(false, str_what + " was not refused");
    } catch (CARGoSException& ex) {
      LOG << "refused: " << ex.what() << std::endl;
      Expect(true, str_what);
    }
  }
  UInt32 m_unChecks = 0, m_unWrong = 0;
};

REGISTER_LOOP_FUNCTIONS(CGardenLoop, "garden")
