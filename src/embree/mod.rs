//! The safe face of Embree 4: device, triangle scene, closest-hit and occlusion queries.
