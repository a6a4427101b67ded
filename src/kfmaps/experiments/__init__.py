"""The paper's experiments, repeated: one module per figure, each writing a table, a picture and its conclusions."""
