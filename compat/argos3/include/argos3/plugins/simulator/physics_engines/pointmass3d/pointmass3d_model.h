// CPointMass3DModel: not carried over.
#error "Tandem's ARGoS layer has no CPointMass3DModel (pointmass3d_model.h). Bodies belong to engines of ours; own ones are plug-ins (docs/engines.md)."
