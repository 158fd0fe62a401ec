//! What a surface reflects: BSDF evaluation, sampling and the upper bounds that lightcuts need.
