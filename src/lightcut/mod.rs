//! Stage 3: a cut through the light trees per point, refined until every cluster's error bound is below the threshold.
