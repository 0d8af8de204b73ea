//! What a well-formed graph is:
//!
//! 1. operands come before the node that uses them (so there are no cycles);
//! 2. a call has as many operands as its row in the table says;
//! 3. no two nodes are equal, and each is found under its own id;
//! 4. a number is in canonical form (one zero, one NaN).

use super::{Expr, ExprId, Graph, OrderedBits};

/// The first breach of the rules, in words.
pub fn verify(graph: &Graph) -> Result<(), String> {
    for (index, expr) in graph.nodes.iter().enumerate() {
        let id = ExprId(index as u32);
        if graph.ids.get(expr) != Some(&id) {
            return Err(format!("node {index} is not found under its own id: {expr:?}"));
        }
        verify_node(id, expr).map_err(|breach| format!("node {index}: {breach}"))?;
    }
    Ok(())
}

fn verify_node(id: ExprId, expr: &Expr) -> Result<(), String> {
    match expr {
        Expr::Number(bits) if OrderedBits::new(bits.value()) != *bits => {
            Err("number is not canonical".into())
        }
        Expr::Call(builtin, operands) if operands.len() != builtin.row().arity => {
            Err(format!("{} operands for {}", operands.len(), builtin.row().name))
        }
        Expr::Call(_, operands) if operands.iter().any(|operand| *operand >= id) => {
            Err("an operand comes after its use".into())
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::graph::builtins::Builtin;

    #[test]
    fn a_graph_built_by_calls_is_well_formed() {
        let mut graph = Graph::new();
        let x = graph.input(0);
        let y = graph.sin(x);
        graph.mul(x, y);
        assert_eq!(verify(&graph), Ok(()));
    }

    #[test]
    fn a_cycle_is_found() {
        let mut graph = Graph::new();
        graph.intern(Expr::Call(Builtin::Sin, [ExprId(0)].into_iter().collect()));
        assert!(verify(&graph).is_err());
    }

    #[test]
    fn a_missing_operand_is_found() {
        let mut graph = Graph::new();
        let x = graph.input(0);
        graph.intern(Expr::Call(Builtin::Add, [x].into_iter().collect()));
        assert!(verify(&graph).is_err());
    }
}
