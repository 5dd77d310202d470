#pragma once
/// The orders of elements, for templates that are compiled once for each.

/// Expands visit(Nodes) for the number of nodes of each order.
#define FLEXARM_FOR_EACH_ORDER(visit) visit(2) visit(3) visit(4) visit(5)
