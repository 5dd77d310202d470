#pragma once
/// A macro that compiles templates for each order of beam elements.

/// Expands visit(Nodes) for the number of nodes of each order.
#define FLEXARM_FOR_EACH_ORDER(visit) visit(2) visit(3) visit(4) visit(5)
