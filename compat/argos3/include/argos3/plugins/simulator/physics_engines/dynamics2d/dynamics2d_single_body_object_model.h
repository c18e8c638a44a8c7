// CDynamics2DSingleBodyObjectModel: not carried over.
#error "Tandem's ARGoS layer has no CDynamics2DSingleBodyObjectModel (dynamics2d_single_body_object_model.h). Bodies belong to engines of ours; own ones are plug-ins (docs/engines.md)."
