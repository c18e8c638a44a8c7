#include "space_loop.h"

#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/controllable_entity.h>
#include <argos3/core/simulator/physics_engine/physics_engine.h>
#include <argos3/core/simulator/simulator.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/ray3.h>
#include <argos3/plugins/robots/e-puck/simulator/epuck_entity.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <argos3/plugins/simulator/entities/battery_equipped_entity.h>
#include <argos3/plugins/simulator/entities/box_entity.h>
#include <argos3/plugins/simulator/entities/cylinder_entity.h>
#include <argos3/plugins/simulator/entities/led_equipped_entity.h>
#include <argos3/plugins/simulator/entities/light_entity.h>
#include <argos3/plugins/simulator/entities/rab_equipped_entity.h>
#include <argos3/plugins/simulator/entities/wheeled_entity.h>
#include <argos3/plugins/simulator/media/led_medium.h>
#include <controllers/wheels/wheels.h>
#include <sstream>

template <typename T>
static void Tell(const std::string& str_key, const T& t_value) {
   LOG << "RESULT " << str_key << " " << t_value << std::endl;
}

static std::string Rounded(const CVector3& c_v) {
   return ToString(Round(c_v.GetX() * 100.0)) + " " + ToString(Round(c_v.GetY() * 100.0)) + " " +
          ToString(Round(c_v.GetZ() * 100.0));
}

size_t CSpaceLoop::Count(const std::string& str_type) {
   try {
      return GetSpace().GetEntitiesByType(str_type).size();
   } catch (CARGoSException&) {
      return 0;
   }
}

void CSpaceLoop::Init(TConfigurationNode&) {
   Tell("count.foot-bots", Count("foot-bot"));
   Tell("count.e-pucks", Count("e-puck"));
   Tell("count.boxes", Count("box"));
   Tell("count.nonsense", Count("nonsense"));
   Tell("count.controllers", Count("controller"));
   Tell("arena.size", Rounded(GetSpace().GetArenaSize()));
   Tell("arena.center", Rounded(GetSpace().GetArenaCenter()));
   Tell("arena.max", Rounded(GetSpace().GetArenaLimits().GetMax()));
   Tell("arena.root", GetSpace().GetRootEntityVector().size());
   Find();
   Components();
   Rays();
   Contacts();
   Move();
}

void CSpaceLoop::Find() {
   std::string strIds;
   CSpace::TMapPerType& tFootBots = GetSpace().GetEntitiesByType("foot-bot");
   for (CSpace::TMapPerType::iterator it = tFootBots.begin(); it != tFootBots.end(); ++it) {
      CFootBotEntity& cFootBot = *any_cast<CFootBotEntity*>(it->second);
      strIds += " " + it->first;
      CWheels& cController = dynamic_cast<CWheels&>(cFootBot.GetControllableEntity().GetController());
      if (cController.GetId() != cFootBot.GetId()) {
         strIds += "(" + cController.GetId() + ")";
      }
   }
   Tell("find.ids", strIds.substr(1));
   CEntity& cBox = GetSpace().GetEntity("wall");
   Tell("find.type", cBox.GetTypeDescription());
   Tell("find.id", cBox.GetId());
   try {
      GetSpace().GetEntity("nowhere");
      Tell("find.missing", "found");
   } catch (CARGoSException&) {
      Tell("find.missing", "CARGoSException");
   }
   CLightEntity& cLight = dynamic_cast<CLightEntity&>(GetSpace().GetEntity("lamp"));
   Tell("light.intensity", cLight.GetIntensity());
   cLight.SetIntensity(0.5);
   cLight.SetColor(CColor::BLUE);
   Tell("light.changed", cLight.GetIntensity());
   std::ostringstream cOut;
   cOut << cLight.GetColor();
   Tell("light.color", cOut.str());
   Tell("light.place", Rounded(cLight.GetPosition()));
}

void CSpaceLoop::Components() {
   CFootBotEntity& cFootBot = *any_cast<CFootBotEntity*>(GetSpace().GetEntitiesByType("foot-bot")["fb0"]);
   CComposableEntity& cWhole = cFootBot;
   Tell("component.has", ToString(cWhole.HasComponent("body")) + ToString(cWhole.HasComponent("wings")));
   CEmbodiedEntity& cBody = cWhole.GetComponent<CEmbodiedEntity>("body");
   Tell("component.same", &cBody == &cFootBot.GetEmbodiedEntity());
   Tell("component.parent", cBody.GetParent().GetId());
   Tell("component.root", cBody.GetRootEntity().GetId());
   CControllableEntity& cControllable = cWhole.GetComponent<CControllableEntity>("controller");
   Tell("component.controller", cControllable.GetController().GetId());
   const SBoundingBox& sBox = cBody.GetBoundingBox();
   Tell("box.x_cm", Round((sBox.MaxCorner.GetX() - sBox.MinCorner.GetX()) * 100.0));
   cBody.CalculateBoundingBox();
   Tell("anchor.origin", Rounded(cBody.GetOriginAnchor().Position));
   Tell("anchor.turret", cBody.GetAnchor("turret").Id);
   CRABEquippedEntity& cRAB = cFootBot.GetRABEquippedEntity();
   Tell("rab.range", cRAB.GetRange());
   Tell("rab.size", cRAB.GetMsgSize());
   CLEDEquippedEntity& cLEDs = cFootBot.GetLEDEquippedEntity();
   Tell("leds.number", cLEDs.GetLEDs().size());
   cLEDs.SetLEDColor(0, CColor::GREEN);
   std::ostringstream cOut;
   cOut << cLEDs.GetLED(0).GetColor();
   Tell("leds.first", cOut.str());
   Tell("wheels.number", cFootBot.GetWheeledEntity().GetNumWheels());
   Tell("battery.charge", cFootBot.GetBatterySensorEquippedEntity().GetAvailableCharge());
   CEPuckEntity& cEPuck = dynamic_cast<CEPuckEntity&>(GetSpace().GetEntity("ep0"));
   Tell("epuck.rab_range", cEPuck.GetRABEquippedEntity().GetRange());
   CCylinderEntity& cCylinder = dynamic_cast<CCylinderEntity&>(GetSpace().GetEntity("post"));
   Tell("cylinder.size",
        ToString(Round(cCylinder.GetRadius() * 100.0)) + " " + ToString(Round(cCylinder.GetHeight() * 100.0)));
   CBoxEntity& cBoxEntity = dynamic_cast<CBoxEntity&>(GetSpace().GetEntity("wall"));
   Tell("box.size", Rounded(cBoxEntity.GetSize()));
   Tell("engine.id", GetSimulator().GetPhysicsEngine("dyn2d").GetId());
   CLEDMedium& cMedium = GetSimulator().GetMedium<CLEDMedium>("leds");
   Tell("medium.id", cMedium.GetId());
   CEntity* pcEntity = &cFootBot;
   Tell("cast.wrong", dynamic_cast<CEPuckEntity*>(pcEntity) == NULL);
}

/* From the origin along x there is the wall's face, 1.95 m away; a body that is excluded is passed */
void CSpaceLoop::Rays() {
   SEmbodiedEntityIntersectionItem sItem;
   const CRay3 cRay(CVector3(0.2, 0.0, 0.05), CVector3(2.2, 0.0, 0.05));
   Tell("ray.hits", GetClosestEmbodiedEntityIntersectedByRay(sItem, cRay));
   Tell("ray.cm", Round(cRay.GetDistance(sItem.TOnRay) * 100.0));
   Tell("ray.body", sItem.IntersectedEntity->GetRootEntity().GetId());
   const CRay3 cAway(CVector3(0.2, 0.0, 0.05), CVector3(0.2, 1.0, 0.05));
   Tell("ray.misses", GetClosestEmbodiedEntityIntersectedByRay(sItem, cAway));
   CFootBotEntity& cFootBot = dynamic_cast<CFootBotEntity&>(GetSpace().GetEntity("fb0"));
   const CRay3 cOut(CVector3(-0.5, 0.0, 0.05), CVector3(0.5, 0.0, 0.05));
   Tell("ray.own", GetClosestEmbodiedEntityIntersectedByRay(sItem, cOut, cFootBot.GetEmbodiedEntity()));
}

void CSpaceLoop::Contacts() {
   CFootBotEntity& cFootBot = dynamic_cast<CFootBotEntity&>(GetSpace().GetEntity("fb1"));
   Tell("contact.none", cFootBot.GetEmbodiedEntity().IsCollidingWithSomething());
}

void CSpaceLoop::Move() {
   CFootBotEntity& cFootBot = dynamic_cast<CFootBotEntity&>(GetSpace().GetEntity("fb1"));
   CEmbodiedEntity& cBody = cFootBot.GetEmbodiedEntity();
   CQuaternion cTurn;
   cTurn.FromEulerAngles(CRadians::PI_OVER_TWO, CRadians::ZERO, CRadians::ZERO);
   Tell("move.to", MoveEntity(cBody, CVector3(-1.0, 1.0, 0.0), cTurn, false));
   Tell("move.place", Rounded(cBody.GetOriginAnchor().Position));
   CRadians cZ, cY, cX;
   cBody.GetOriginAnchor().Orientation.ToEulerAngles(cZ, cY, cX);
   Tell("move.yaw", Round(ToDegrees(cZ).GetValue()));
   Tell("move.check", cBody.MoveTo(CVector3(1.0, 1.0, 0.0), cTurn, true));
   Tell("move.checked", Rounded(cBody.GetOriginAnchor().Position));
   Tell("move.taken", cBody.MoveTo(CVector3(0.0, 0.0, 0.0), cTurn, false));
   Tell("move.stays", Rounded(cBody.GetOriginAnchor().Position));
}

void CSpaceLoop::Add() {
   for (UInt32 i = 0; i < 3; ++i) {
      std::ostringstream cId;
      cId << "new" << i;
      CFootBotEntity* pcFootBot = new CFootBotEntity(cId.str(), "wc", CVector3(-1.5, -1.0 + 0.5 * i, 0.0),
                                                     CQuaternion(CRadians::ZERO, CVector3::Z));
      AddEntity(*pcFootBot);
   }
   AddEntity(*new CBoxEntity("crate", CVector3(1.0, -1.5, 0.0), CQuaternion(), true, CVector3(0.2, 0.2, 0.2), 2.0));
   AddEntity(*new CCylinderEntity("barrel", CVector3(0.0, -1.5, 0.0), CQuaternion(), false, 0.1, 0.3));
   CBoxEntity& cCrate = dynamic_cast<CBoxEntity&>(GetSpace().GetEntity("crate"));
   Tell("add.mass", cCrate.GetMass());
   Tell("add.boxes", Count("box"));
   Tell("add.foot-bots", Count("foot-bot"));
   Tell("add.controllers", Count("controller"));
   try {
      CFootBotEntity* pcTwice = new CFootBotEntity("new0", "wc", CVector3(-1.5, 1.5, 0.0));
      AddEntity(*pcTwice);
      Tell("add.twice", "added");
   } catch (CARGoSException&) {
      Tell("add.twice", "CARGoSException");
   }
}

void CSpaceLoop::Remove() {
   CFootBotEntity& cAdded = dynamic_cast<CFootBotEntity&>(GetSpace().GetEntity("new1"));
   Tell("added.steps", dynamic_cast<CWheels&>(cAdded.GetControllableEntity().GetController()).GetSteps());
   Tell("added.place", Rounded(cAdded.GetEmbodiedEntity().GetOriginAnchor().Position));
   RemoveEntity("new0");
   RemoveEntity(cAdded);
   RemoveEntity("crate");
   Tell("remove.foot-bots", Count("foot-bot"));
   Tell("remove.boxes", Count("box"));
   try {
      RemoveEntity("nowhere");
      Tell("remove.missing", "removed");
   } catch (CARGoSException&) {
      Tell("remove.missing", "CARGoSException");
   }
}

void CSpaceLoop::PreStep() {
   CFootBotEntity& cFootBot = dynamic_cast<CFootBotEntity&>(GetSpace().GetEntity("fb1"));
   if (GetSpace().GetSimulationClock() == 2) {
      Add();
   }
   if (GetSpace().GetSimulationClock() == 12) {
      /* A disabled device of an entity: the other robots hear it no more */
      cFootBot.GetRABEquippedEntity().Disable();
      Tell("rab.enabled", cFootBot.GetRABEquippedEntity().IsEnabled());
      cFootBot.GetRABEquippedEntity().Enable();
      Tell("rab.enabled_again", cFootBot.GetRABEquippedEntity().IsEnabled());
   }
}

void CSpaceLoop::PostStep() {
   if (GetSpace().GetSimulationClock() == 12) {
      Remove();
   }
   if (GetSpace().GetSimulationClock() == 14) {
      Tell("left.foot-bots", Count("foot-bot"));
      Tell("left.place", Rounded(dynamic_cast<CFootBotEntity&>(GetSpace().GetEntity("new2"))
                                     .GetEmbodiedEntity()
                                     .GetOriginAnchor()
                                     .Position));
   }
}

void CSpaceLoop::Reset() {
   Tell("reset.clock", GetSpace().GetSimulationClock());
}

REGISTER_LOOP_FUNCTIONS(CSpaceLoop, "space_loop")
